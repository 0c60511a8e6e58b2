// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/parse.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>
#include <system_error>

#include "iksel/error.hpp"
#include "urdf/precheck.hpp"

namespace iksel {
namespace {

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
    text_ += text;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static inline std::mutex mutex;
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* previous_ = nullptr;
  std::string text_;
};

/// One line out of many, so that an error stays one line.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return text;
}

/// What urdfdom says, which is only what it met, and what to do about it.
struct Remedy {
  const char* message;
  const char* remedy;
};

constexpr Remedy kRemedies[] = {
    {"No name given for the robot", "give the <robot> a name"},
    {"No link elements found", "it needs a <link> for each body"},
    {"no XML element", "give the path of a URDF file, or its text"},
    {"has no known type", "a joint is revolute, continuous, prismatic, fixed, planar or floating"},
    {"Unknown geometry type", "a geometry is a box, cylinder, sphere or mesh"},
    {"expected while parsing vector", "give as many numbers as are expected"},
    {"Unable to parse component", "write numbers as in xyz=\"0 0.5 -1e-3\", without commas"},
    {"is not a valid float", "write the number as in -1.57"},
};

/// The remedies for messages, or nothing.
std::string find_remedies(const std::string& messages) {
  std::string text;
  for (const Remedy& entry : kRemedies) {
    if (messages.find(entry.message) != std::string::npos) text += std::string("; ") + entry.remedy;
  }
  return text;
}

/// Length of the UTF-8 sequence that begins at `at`; 0: none does.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned lead = byte(at);
  if (lead < 0x80) return 1;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  // Not longer than need be, no half of a surrogate pair, nothing beyond the last character.
  const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (byte(at + 1) < least || byte(at + 1) > most) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte(at + i) < 0x80 || byte(at + i) > 0xBF) return 0;
  }
  return length;
}

/// Letters of other encodings, as in authors' names, become question marks: names and messages are
/// shown as text.
void replace_what_is_no_utf8(std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) text[i] = '?';
    i += std::max<std::size_t>(length, 1);
  }
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
  // Devices never end.
  constexpr std::size_t kMost = 256U << 20U;
  std::string text;
  for (char c = 0; file.get(c);) {
    text += c;
    if (text.size() > kMost) {
      throw UrdfError("URDF file '" + path.string() + "' is larger than 256 MiB");
    }
  }
  if (file.bad()) throw UrdfError("cannot read URDF file '" + path.string() + "'");
  replace_what_is_no_utf8(text);
  return text;
}

urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml) {
  const std::string text = prepare_urdf(xml);
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
    const std::string reason = explain_broken_xml(xml);
    if (!reason.empty()) messages = reason + " (" + messages + ")";
    throw UrdfError(
        "URDF does not parse: " + (messages.empty() ? "no robot in it" : one_line(messages)) +
        find_remedies(messages));
  }
  return model;
}

std::vector<std::string> joint_names_of(const urdf::ModelInterface& model) {
  std::vector<std::string> names;
  for (const auto& entry : model.joints_) names.push_back(entry.first);
  return names;
}

const char* joint_type_name(int type) {
  switch (type) {
    case urdf::Joint::REVOLUTE:
      return "revolute";
    case urdf::Joint::CONTINUOUS:
      return "continuous";
    case urdf::Joint::PRISMATIC:
      return "prismatic";
    case urdf::Joint::FIXED:
      return "fixed";
    case urdf::Joint::FLOATING:
      return "floating";
    case urdf::Joint::PLANAR:
      return "planar";
    default:
      return "of an unknown type";
  }
}

void throw_if_xacro(const std::string& xml, const std::string& reason) {
  const std::string sign = find_xacro(xml);
  if (sign.empty()) return;
  throw UrdfError("it is xacro (" + one_line(sign) +
                  "), which has to be expanded first: xacro FILE > robot.urdf, or in Python "
                  "iksel.load_robot(FILE) (as URDF: " +
                  reason + ")");
}

}  // namespace iksel
