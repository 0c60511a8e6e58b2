// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "urdf/urdf_text.hpp"

namespace iksel {
namespace {

struct Joint {
  std::string name, parent, child;
};

Joint joint_of(const XmlElement& element) {
  const auto link_at = [&](const char* end) {
    const XmlElement* const child = element.child(end);
    return child == nullptr ? "" : child->value("link");
  };
  return {element.value("name"), link_at("parent"), link_at("child")};
}

/// The joints of a URDF by their child links.
std::map<std::string, Joint> find_carriers(const XmlElement& robot) {
  std::set<std::string> links;
  for (const XmlElement& element : robot.children) {
    if (element.name == "link") links.insert(element.value("name"));
  }
  if (links.count("") > 0) throw UrdfError("URDF does not parse: give each <link> a name");
  std::map<std::string, Joint> carriers;
  for (const XmlElement& element : robot.children) {
    if (element.name != "joint") continue;
    const Joint joint = joint_of(element);
    for (const std::string& link : {joint.parent, joint.child}) {
      if (links.count(link) > 0) continue;
      throw UrdfError("joint '" + joint.name + "' needs <parent link=\"...\"/> and <child " +
                      "link=\"...\"/>, and each of them a <link>; there is none named '" + link +
                      "'");
    }
    const auto [first, is_new] = carriers.try_emplace(joint.child, joint);
    if (is_new) continue;
    throw UrdfError("link '" + joint.child + "' is the child of two joints: '" +
                    first->second.name + "' and '" + joint.name + "'");
  }
  return carriers;
}

/// The root above each link that a joint carries.
std::map<std::string, std::string> find_roots(const std::map<std::string, Joint>& carriers) {
  std::map<std::string, std::string> roots;
  for (const auto& carrier : carriers) {
    std::set<std::string> way;
    std::string link = carrier.first;
    for (auto at = carriers.find(link); at != carriers.end() && roots.count(link) == 0;
         at = carriers.find(link)) {
      const Joint& joint = at->second;
      if (!way.insert(link).second) {
        throw UrdfError("URDF is no tree: joint '" + joint.name + "' from link '" + joint.parent +
                        "' to link '" + joint.child + "' closes a circle of links");
      }
      link = joint.parent;
    }
    const auto known = roots.find(link);
    const std::string root = known == roots.end() ? link : known->second;
    for (const std::string& passed : way) roots[passed] = root;
  }
  return roots;
}

}  // namespace

void keep_one_tree(XmlElement& robot, const std::vector<std::string>& links) {
  const auto roots = find_roots(find_carriers(robot));
  const auto root_of = [&](const std::string& name) {
    const auto found = roots.find(name);
    return found == roots.end() ? name : found->second;
  };
  std::vector<std::string> all;  // roots, in the order of the file
  std::set<std::string> known;   // the same, to look them up
  const std::string* kept = nullptr;
  for (const XmlElement& element : robot.children) {
    if (element.name != "link") continue;
    const std::string name = element.value("name");
    const std::string root = root_of(name);
    if (known.insert(root).second) all.push_back(root);
    const auto meant = std::find(links.begin(), links.end(), name);
    if (meant == links.end()) continue;
    if (kept != nullptr && root_of(*kept) != root) {
      throw UrdfError("links '" + links.front() + "' and '" + links.back() +
                      "' are not connected: they hang in different trees, whose roots are " +
                      list_names({root_of(links.front()), root_of(links.back())}));
    }
    kept = &*meant;
  }
  if (all.size() < 2) return;
  if (kept == nullptr) {
    throw UrdfError("its links hang in several trees, whose roots are " + list_names(all) +
                        ": give base_link and tip_link, both of one tree, or join the roots by "
                        "fixed joints",
                    all);
  }
  const auto is_strange = [&](const XmlElement& element) {
    if (element.name != "link" && element.name != "joint") return false;
    const bool is_link = element.name == "link";
    const std::string link = is_link ? element.value("name") : joint_of(element).parent;
    return root_of(link) != root_of(*kept);
  };
  auto& parts = robot.children;
  parts.erase(std::remove_if(parts.begin(), parts.end(), is_strange), parts.end());
}

}  // namespace iksel
