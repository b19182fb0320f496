#include "boards/stm32f405/core/semihosting.hpp"

namespace inkwell::virtual_board {
namespace {
enum : std::uint32_t {
  sys_open = 0x01,
  sys_close = 0x02,
  sys_writec = 0x03,
  sys_write0 = 0x04,
  sys_write = 0x05,
  sys_istty = 0x09,
  sys_seek = 0x0A,
  sys_flen = 0x0C,
  sys_errno = 0x13,
  sys_get_cmdline = 0x15,
  sys_heapinfo = 0x16,
  sys_exit = 0x18,
  sys_exit_extended = 0x20,
};
constexpr std::uint32_t stopped_application_exit = 0x20026;
constexpr std::uint32_t failure = 0xFFFF'FFFF;
constexpr std::uint32_t text_limit = 64 * 1024;
}  // namespace

SemihostingAnswer semihosting_call(std::uint32_t operation, std::uint32_t parameter, const AddressSpace& memory,
                                   const std::function<void(std::uint8_t)>& console) {
  const auto put = [&](std::uint32_t address, std::uint32_t bytes) {
    const std::uint8_t* text = memory.at(address, bytes);
    if (text == nullptr) return false;
    for (std::uint32_t i = 0; i < bytes; ++i)
      if (console) console(text[i]);
    return true;
  };
  switch (operation) {
    case sys_open: return {1, {}, true};  // every file is the console
    case sys_close: return {0, {}, true};
    case sys_writec: return {put(parameter, 1) ? operation : failure, {}, true};
    case sys_write0:
      for (std::uint32_t i = 0; i < text_limit; ++i) {
        const std::uint8_t* character = memory.at(parameter + i, 1);
        if (character == nullptr || *character == 0) break;
        if (console) console(*character);
      }
      return {operation, {}, true};
    case sys_write: {
      const std::uint32_t bytes = memory.word(parameter + 8);
      return {put(memory.word(parameter + 4), bytes) ? 0 : bytes, {}, true};
    }
    case sys_istty: return {1, {}, true};
    case sys_exit: return {0, parameter == stopped_application_exit ? 0 : 1, true};
    case sys_exit_extended:
      return {0, memory.word(parameter) == stopped_application_exit ? static_cast<int>(memory.word(parameter + 4)) : 1,
              true};
    case sys_seek:
    case sys_flen:
    case sys_errno: return {0, {}, true};
    case sys_get_cmdline:
    case sys_heapinfo:
    default: return {failure, {}, false};
  }
}

}  // namespace inkwell::virtual_board
