#include <local/process_name.hpp>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

namespace inkwell::local {

std::string printable(std::string_view text) {
  std::string shown(text);
  std::ranges::replace_if(
      shown, [](char character) { return character < ' ' || character > '~'; }, '?');
  return shown;
}

std::string name_of_process(pid_t process) {
  std::string name;
  std::getline(std::ifstream(fmt::format("/proc/{}/comm", process)), name);
  return name.empty() ? fmt::format("process {}", process) : fmt::format("{} (process {})", printable(name), process);
}

}  // namespace inkwell::local
