// Log of the chip. The log reports each access to unmodeled hardware once.
#pragma once

#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <vector>
#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

class Log final : public UnmodelledLog {
 public:
  explicit Log(std::function<void(const std::string&)> sink) : sink_(std::move(sink)) {
    if (!sink_) sink_ = [](const std::string& line) { std::fprintf(stderr, "chip: %s\n", line.c_str()); };
  }
  void say(const std::string& line) { sink_(line); }
  /// Logs each line once. During a register access, the function adds the code location to the line.
  void say_once(const std::string& line) {
    if (!said_.insert(line).second) return;
    unmodelled_.push_back(accessing_ && code ? line + ", " + code() : line);
    sink_(unmodelled_.back());
  }
  /// During the lifetime of this object, the processor accesses a register.
  class Access {
   public:
    explicit Access(Log& log) : log_(log) { log_.accessing_ = true; }
    ~Access() { log_.accessing_ = false; }
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;

   private:
    Log& log_;
  };
  /// Returns a description of the running code.
  std::function<std::string()> code;
  void note(const std::string& peripheral, std::uint32_t offset, bool write, std::uint32_t value) override {
    char text[64];
    if (write)
      std::snprintf(text, sizeof text, " + 0x%03X is not modeled: write of 0x%08X ignored", offset, value);
    else
      std::snprintf(text, sizeof text, " + 0x%03X is not modeled: reads 0", offset);
    // The key excludes the value, because each register is logged once for reads and once for writes.
    const std::string access = peripheral + (write ? " w " : " r ") + std::to_string(offset);
    if (!accesses_.insert(access).second) return;
    say_once(peripheral + text);
  }
  const std::vector<std::string>& lines() const { return unmodelled_; }

 private:
  std::function<void(const std::string&)> sink_;
  std::set<std::string> said_, accesses_;
  std::vector<std::string> unmodelled_;
  bool accessing_ = false;
};

}  // namespace inkwell::virtual_board
