#include "host/client/local/process_name.hpp"

#include <fstream>

#include <fmt/format.h>

#include "protocol/plain_text.hpp"

namespace inkwell::local {

std::string name_of_process(pid_t process) {
  std::string name;
  std::getline(std::ifstream(fmt::format("/proc/{}/comm", process)), name);
  return name.empty() ? fmt::format("process {}", process)
                      : fmt::format("{} (process {})", protocol::plain_text(name), process);
}

}  // namespace inkwell::local
