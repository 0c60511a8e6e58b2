// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/precheck.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "iksel/error.hpp"
#include "urdf/xml_scan.hpp"

namespace iksel {
namespace {

/// A URDF needs half a dozen levels. urdfdom's XML parser calls itself for each level and would run
/// out of stack on text made to be deep.
constexpr int kMaxDepth = 200;

constexpr int kJointDepth = 2;  // robot, joint

struct JointElement {
  std::string_view name, type, parent, child;
  std::size_t content = 0;  ///< where it begins
  bool has_limit = false;
};

struct Insertion {
  std::size_t at;
  std::string_view text;
};

class UrdfScan {
 public:
  explicit UrdfScan(const std::string& xml) {
    XmlTag tag;
    for (XmlScanner scanner(xml); scanner.next(tag);) {
      if (tag.depth > kMaxDepth) {
        throw UrdfError("URDF does not parse: its elements are nested deeper than " +
                        std::to_string(kMaxDepth) + " levels");
      }
      if (tag.opens) read(tag);
    }
  }

  [[nodiscard]] const std::vector<JointElement>& joints() const { return joints_; }

  [[nodiscard]] std::vector<Insertion> insertions() const {
    std::vector<Insertion> all = in_limits_;
    for (const JointElement& joint : joints_) {
      if (joint.has_limit || (joint.type != "revolute" && joint.type != "prismatic")) continue;
      all.push_back({joint.content, R"(<limit effort="0" velocity="0"/>)"});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Insertion& a, const Insertion& b) { return a.at < b.at; });
    return all;
  }

 private:
  void read(const XmlTag& tag) {
    const auto value = [&](std::string_view key) { return tag.attribute(key).value_or(""); };
    if (tag.depth == kJointDepth) {
      in_joint_ = tag.name == "joint" && !tag.closes;
      if (in_joint_) joints_.push_back({value("name"), value("type"), {}, {}, tag.end});
    } else if (in_joint_ && tag.depth == kJointDepth + 1) {
      JointElement& joint = joints_.back();
      if (tag.name == "parent") joint.parent = value("link");
      if (tag.name == "child") joint.child = value("link");
      if (tag.name == "limit") {
        joint.has_limit = true;
        const std::size_t behind_name = tag.begin + tag.name.size();
        if (!tag.attribute("effort")) in_limits_.push_back({behind_name, R"( effort="0")"});
        if (!tag.attribute("velocity")) in_limits_.push_back({behind_name, R"( velocity="0")"});
      }
    }
  }

  std::vector<JointElement> joints_;
  std::vector<Insertion> in_limits_;
  bool in_joint_ = false;
};

/// Links that form a circle never end a walk to the root, and urdfdom loses their memory: each owns
/// the next.
void check_circles(const std::vector<JointElement>& joints) {
  std::map<std::string_view, std::vector<const JointElement*>> below;
  std::map<std::string_view, int> parents;
  for (const JointElement& joint : joints) {
    if (joint.parent.empty() || joint.child.empty()) continue;
    below[joint.parent].push_back(&joint);
    parents[joint.parent];
    ++parents[joint.child];
  }
  // Take away links without parents, one after the other: what is left hangs on a circle.
  std::vector<std::string_view> roots;
  for (const auto& [link, count] : parents) {
    if (count == 0) roots.push_back(link);
  }
  std::size_t left = parents.size();
  while (!roots.empty()) {
    const std::string_view root = roots.back();
    roots.pop_back();
    --left;
    for (const JointElement* joint : below[root]) {
      if (--parents[joint->child] == 0) roots.push_back(joint->child);
    }
  }
  if (left == 0) return;
  std::map<std::string_view, const JointElement*> above;
  for (const JointElement& joint : joints) {
    if (parents[joint.child] > 0 && parents[joint.parent] > 0) above[joint.child] = &joint;
  }
  std::set<std::string_view> seen;
  const JointElement* joint = above.begin()->second;
  while (seen.insert(joint->child).second) joint = above.at(joint->parent);
  throw UrdfError("URDF is no tree: joint '" + std::string(joint->name) + "' from link '" +
                  std::string(joint->parent) + "' to link '" + std::string(joint->child) +
                  "' closes a circle of links");
}

}  // namespace

std::string prepare_urdf(const std::string& xml) {
  const UrdfScan scan(xml);
  check_circles(scan.joints());
  std::string text;
  std::size_t done = 0;
  for (const Insertion& insertion : scan.insertions()) {
    text.append(xml, done, insertion.at - done).append(insertion.text);
    done = insertion.at;
  }
  return text.append(xml, done);
}

std::string explain_broken_xml(const std::string& xml) {
  XmlScanner scanner(xml);
  XmlTag tag;
  if (!scanner.next(tag)) return "there is no XML element in it";
  while (scanner.next(tag)) continue;
  return scanner.depth() > 0 ? "it ends before its elements do, as if it was cut off" : "";
}

std::string find_xacro(const std::string& xml) {
  bool declared = false;
  XmlTag tag;
  for (XmlScanner scanner(xml); scanner.next(tag);) {
    if (tag.name.substr(0, 6) == "xacro:") return "<" + std::string(tag.name) + ">";
    declared = declared || tag.attribute("xmlns:xacro").has_value();
    if (!declared) continue;
    for (const char* start : {"${", "$("}) {
      const std::size_t at = tag.attributes.find(start);
      if (at != std::string_view::npos) return std::string(tag.attributes.substr(at, 20));
    }
  }
  return "";
}

}  // namespace iksel
