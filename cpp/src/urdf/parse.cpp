// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/parse.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <mutex>
#include <sstream>

#include "iksel/error.hpp"

namespace iksel {
namespace {

/// While it lives, console_bridge's messages are collected instead of printed. console_bridge has
/// one handler for the whole process, so only one collector lives at a time.
class MessageCollector : public console_bridge::OutputHandler {
 public:
  MessageCollector() : lock_(mutex()), level_(console_bridge::getLogLevel()) {
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
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* previous_ = nullptr;
  std::string text_;
};

/// A URDF needs half a dozen levels. urdfdom's XML parser calls itself for each level and would run
/// out of stack on text made to be deep.
constexpr int kMaxDepth = 200;

/// Depth of the deepest element of XML text, as far as its tags tell.
int xml_depth(const std::string& xml) {
  const auto skip_to = [&](std::size_t from, const char* end) {
    const std::size_t at = xml.find(end, from);
    return at == std::string::npos ? xml.size() : at;
  };
  int depth = 0;
  int deepest = 0;
  for (std::size_t i = xml.find('<'); i < xml.size(); i = xml.find('<', i + 1)) {
    if (xml.compare(i, 4, "<!--") == 0) {
      i = skip_to(i, "-->");
    } else if (xml.compare(i, 9, "<![CDATA[") == 0) {
      i = skip_to(i, "]]>");
    } else if (xml.compare(i, 2, "</") == 0) {
      --depth;
    } else if (xml.compare(i, 2, "<?") != 0 && xml.compare(i, 2, "<!") != 0) {
      const std::size_t end = skip_to(i, ">");
      deepest = std::max(deepest, ++depth);
      if (xml[end - 1] == '/') --depth;
    }
    if (i >= xml.size()) break;
  }
  return deepest;
}

/// One line out of many, so that an error stays one line.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return text;
}

}  // namespace

std::string read_urdf_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw UrdfError("URDF file '" + path.string() + "' is a directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw UrdfError("cannot open URDF file '" + path.string() + "'");
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw UrdfError("cannot read URDF file '" + path.string() + "'");
  return text.str();
}

urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml) {
  if (xml_depth(xml) > kMaxDepth) {
    throw UrdfError("URDF does not parse: its elements are nested deeper than " +
                    std::to_string(kMaxDepth) + " levels");
  }
  urdf::ModelInterfaceSharedPtr model;
  std::string messages;
  {
    const MessageCollector collector;
    try {
      model = urdf::parseURDF(xml);
      messages = collector.text();
    } catch (const std::exception& error) {
      messages = collector.text() + " " + error.what();
    }
  }
  if (!model) {
    throw UrdfError("URDF does not parse: " +
                    (messages.empty() ? "no robot in it" : one_line(messages)));
  }
  return model;
}

}  // namespace iksel
