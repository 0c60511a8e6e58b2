// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/precheck.hpp"

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
  std::string_view name, parent, child;
};

/// Reads the joints, and adds to the text what urdfdom insists on.
class UrdfScan {
 public:
  explicit UrdfScan(const std::string& xml) : xml_(xml) {
    XmlTag tag;
    for (XmlScanner scanner(xml); scanner.next(tag);) {
      if (tag.depth > kMaxDepth) {
        throw UrdfError("URDF does not parse: its elements are nested deeper than " +
                        std::to_string(kMaxDepth) + " levels");
      }
      if (tag.opens) {
        open(tag);
      } else if (tag.depth == kJointDepth && lacks_limit_) {
        insert(tag.begin - kBeforeName, R"(<limit effort="0" velocity="0"/>)");
        lacks_limit_ = false;
      }
    }
    text_.append(xml, copied_);
  }

  [[nodiscard]] const std::vector<JointElement>& joints() const { return joints_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static constexpr std::size_t kBeforeName = 2;  ///< characters of "</"

  void open(const XmlTag& tag) {
    const auto value = [&](std::string_view key) { return tag.attribute(key).value_or(""); };
    if (tag.depth == kJointDepth) {
      in_joint_ = tag.name == "joint" && !tag.closes;
      if (in_joint_) joints_.push_back({value("name"), {}, {}});
      lacks_limit_ = in_joint_ && (value("type") == "revolute" || value("type") == "prismatic");
    } else if (in_joint_ && tag.depth == kJointDepth + 1) {
      if (tag.name == "parent") joints_.back().parent = value("link");
      if (tag.name == "child") joints_.back().child = value("link");
      if (tag.name == "limit") {
        lacks_limit_ = false;
        const std::size_t behind_name = tag.begin + tag.name.size();
        if (!tag.attribute("effort")) insert(behind_name, R"( effort="0")");
        if (!tag.attribute("velocity")) insert(behind_name, R"( velocity="0")");
      }
    }
  }

  void insert(std::size_t at, std::string_view what) {
    text_.append(xml_, copied_, at - copied_).append(what);
    copied_ = at;
  }

  const std::string& xml_;
  std::string text_;
  std::size_t copied_ = 0;
  std::vector<JointElement> joints_;
  bool in_joint_ = false;
  bool lacks_limit_ = false;
};

/// Of several joints that carry one link urdfdom keeps the last; and links that form a circle never
/// end a walk to the root, and are memory that urdfdom loses: each owns the next.
void check_tree(const std::vector<JointElement>& joints) {
  std::map<std::string_view, const JointElement*> carriers;
  for (const JointElement& joint : joints) {
    if (joint.parent.empty() || joint.child.empty()) continue;
    const auto [first, is_new] = carriers.try_emplace(joint.child, &joint);
    if (is_new) continue;
    throw UrdfError("link '" + std::string(joint.child) + "' is the child of two joints: '" +
                    std::string(first->second->name) + "' and '" + std::string(joint.name) + "'");
  }
  std::set<std::string_view> hang_on_root;
  for (const auto& carrier : carriers) {
    std::set<std::string_view> way;
    auto at = carriers.find(carrier.first);
    for (; at != carriers.end() && !hang_on_root.count(at->first);
         at = carriers.find(at->second->parent)) {
      if (way.insert(at->first).second) continue;
      const JointElement& joint = *at->second;
      throw UrdfError("URDF is no tree: joint '" + std::string(joint.name) + "' from link '" +
                      std::string(joint.parent) + "' to link '" + std::string(joint.child) +
                      "' closes a circle of links");
    }
    hang_on_root.merge(way);
  }
}

}  // namespace

std::string prepare_urdf(const std::string& xml) {
  const UrdfScan scan(xml);
  check_tree(scan.joints());
  return scan.text();
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
