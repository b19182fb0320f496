// Stand-in for the header of rclcpp. It declares only what the example uses, and is not a copy.
#pragma once

#include <cstdio>
#include <string>
#include <utility>

namespace rclcpp {

class Time {};
class Duration {};

class Logger {
 public:
  explicit Logger(std::string name) : name_(std::move(name)) {}
  const char* get_name() const { return name_.c_str(); }

 private:
  std::string name_;
};
inline Logger get_logger(const std::string& name) { return Logger(name); }

/// The newest logged text, for tests.
inline std::string& newest_text() {
  static std::string text;
  return text;
}

}  // namespace rclcpp

#define RCLCPP_ERROR(logger, ...)                                             \
  do {                                                                        \
    char text[2048];                                                          \
    std::snprintf(text, sizeof text, __VA_ARGS__);                            \
    rclcpp::newest_text() = (logger).get_name() + (": " + std::string(text)); \
  } while (false)
