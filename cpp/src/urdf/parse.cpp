// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/parse.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cerrno>
#include <exception>
#include <fstream>
#include <mutex>
#include <system_error>
#include <utility>

#include "urdf/urdf_text.hpp"

namespace iksel {
namespace {

/// console_bridge ends a long message after a number of bytes: what it left of a character goes.
std::string without_cut_character(std::string text) {
  std::size_t last = text.size();
  while (last > 0 && (static_cast<unsigned char>(text[last - 1]) & 0xC0U) == 0x80) --last;
  if (last == 0) return text;
  const auto lead = static_cast<unsigned char>(text[--last]);
  const std::size_t length = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (text.size() - last < length) text.erase(last);
  return text;
}

/// While it lives, console_bridge's messages are collected instead of printed. console_bridge has
/// one handler for the whole process, so only one collector lives at a time.
class MessageCollector : public console_bridge::OutputHandler {
 public:
  MessageCollector() : lock_(mutex), level_(console_bridge::getLogLevel()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    previous_ = console_bridge::getOutputHandler();
    console_bridge::useOutputHandler(this);
  }
  MessageCollector(const MessageCollector&) = delete;
  MessageCollector& operator=(const MessageCollector&) = delete;
  ~MessageCollector() override {
    console_bridge::useOutputHandler(previous_);
    console_bridge::setLogLevel(level_);
  }

  void log(const std::string& text, console_bridge::LogLevel /*level*/, const char* /*filename*/,
           int /*line*/) override {
    if (!text_.empty()) text_ += "; ";
    text_ += without_cut_character(text);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static inline std::mutex mutex;
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* previous_ = nullptr;
  std::string text_;
};

/// What urdfdom says, which is only what it met, and what to do about it.
constexpr std::pair<const char*, const char*> kRemedies[] = {
    {"unnamed joint found", "give each <joint> a name"},
    {"is not unique", "give each a name of its own"},
    {"No link elements found", "it needs a <link> for each body"},
    {"no XML element", "give the path of a URDF file, or its text"},
    {"has no type", "write type=\"revolute\" or what it is"},
    {"has no known type", "a joint is revolute, continuous, prismatic, fixed, planar or floating"},
    {"expected while parsing vector", "give as many numbers as are expected"},
    {"Unable to parse component", "write numbers as in xyz=\"0 0.5 -1e-3\", without commas"},
    {"is not a valid float", "write the number as in -1.57"},
};

/// The remedies for messages, or nothing.
std::string find_remedies(const std::string& messages) {
  std::string text;
  for (const auto& [message, remedy] : kRemedies) {
    if (messages.find(message) != std::string::npos) text += std::string("; ") + remedy;
  }
  return text;
}

/// The root element of a URDF; throws UrdfError where it is none.
XmlElement read_robot(const std::string& xml) {
  std::string name;
  std::string reason;
  try {
    XmlElement root = parse_xml(xml, &name);
    reason = explain_root(name);
    if (reason.empty()) return root;
  } catch (const UrdfError& error) {
    const std::string other = explain_root(name);
    reason = error.what() + find_remedies(error.what()) + (other.empty() ? "" : "; " + other);
  }
  throw UrdfError("URDF does not parse: " + reason);
}

}  // namespace

std::string read_urdf_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw UrdfError("URDF file '" + path.string() + "' is a directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw UrdfError("cannot open URDF file '" + path.string() +
                    "': " + std::generic_category().message(errno));
  }
  std::string text;
  for (char c = 0; file.get(c);) {
    text += c;
    if (text.size() > 256U << 20U) {  // devices never end
      throw UrdfError("URDF file '" + path.string() + "' is larger than 256 MiB");
    }
  }
  if (file.bad()) throw UrdfError("cannot read URDF file '" + path.string() + "'");
  return text;
}

urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml,
                                         const std::vector<std::string>& links) {
  XmlElement robot = read_robot(xml);
  keep_one_tree(robot, links);
  replace_quaternions(robot);
  const std::string text = kinematic_text(robot);
  urdf::ModelInterfaceSharedPtr model;
  std::string messages;
  {
    const MessageCollector collector;
    try {
      model = urdf::parseURDF(text);
      messages = collector.text();
    } catch (const std::exception& error) {
      messages = collector.text() + " " + error.what();
    }
  }
  if (!model) {
    throw UrdfError("URDF does not parse: " + one_line(messages) + find_remedies(messages));
  }
  return model;
}

std::vector<std::string> joint_names_of(const urdf::ModelInterface& model) {
  std::vector<std::string> names;
  for (const auto& entry : model.joints_) names.push_back(entry.first);
  return names;
}

const char* joint_type_name(int type) {
  constexpr const char* kNames[] = {"of an unknown type", "revolute", "continuous", "prismatic",
                                    "floating",           "planar",   "fixed"};
  static_assert(urdf::Joint::REVOLUTE == 1 && urdf::Joint::FIXED == 6, "the order of urdfdom");
  return kNames[type];
}

void throw_if_xacro(const std::string& xml, const std::string& reason) {
  std::string sign;
  try {
    sign = find_xacro(parse_xml(xml));
  } catch (const UrdfError&) {
    return;  // the XML itself is the reason
  }
  if (sign.empty()) return;
  throw UrdfError("it is xacro (" + sign +
                  "), which has to be expanded first: xacro FILE > robot.urdf, or in Python "
                  "iksel.load_robot(FILE) (as URDF: " +
                  reason + ")");
}

}  // namespace iksel
