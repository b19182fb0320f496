#include "boards/virtual/program/profile.hpp"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

namespace inkwell::virtual_board {

void Profile::instruction(unsigned exception, std::uint32_t address, std::uint64_t cycles) {
  if (exception != exception_ && !run_.empty()) {
    run_.push_back({address, cycles});
    const std::uint64_t length = cycles - run_.front().begin_cycle;
    if (length > longest_cycles_) {
      longest_cycles_ = length;
      longest_.swap(run_);
    }
    run_.clear();
  }
  exception_ = exception;
  if (exception != 0) run_.push_back({address, cycles});
}

void Profile::write(const std::filesystem::path& file) const {
  std::ofstream out(file);
  for (std::size_t i = 0; i + 1 < longest_.size(); ++i)
    out << fmt::format("{:08x} {}\n", longest_[i].address, longest_[i + 1].begin_cycle - longest_[i].begin_cycle);
  out.flush();
  if (!out) throw std::runtime_error(fmt::format("The profile cannot be written to {}.", file.string()));
}

}  // namespace inkwell::virtual_board
