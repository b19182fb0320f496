#include "tests/target/semihosting.hpp"

#include <sys/stat.h>

#include <cerrno>

namespace inkwell::semihosting {

namespace {

enum class Operation : std::uint32_t { open = 0x01, write = 0x05, exit_extended = 0x20 };

std::uint32_t call(Operation operation, const void* parameters) {
  register std::uint32_t r0 asm("r0") = static_cast<std::uint32_t>(operation);
  register const void* r1 asm("r1") = parameters;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

/// Returns a handle of the simulator's standard output (":tt" in mode 4).
std::uint32_t standard_output() {
  static const struct {
    const char* name;
    std::uint32_t mode;
    std::uint32_t name_length;
  } parameters{":tt", 4, 3};
  static const std::uint32_t handle = call(Operation::open, &parameters);
  return handle;
}

}  // namespace

void write(const char* bytes, std::size_t count) {
  const struct {
    std::uint32_t handle;
    const char* bytes;
    std::uint32_t count;
  } parameters{standard_output(), bytes, count};
  call(Operation::write, &parameters);
}

void write(const char* text) { write(text, __builtin_strlen(text)); }

[[noreturn]] void exit(int code) {
  constexpr std::uint32_t application_exit = 0x20026;
  const struct {
    std::uint32_t reason;
    std::uint32_t code;
  } parameters{application_exit, static_cast<std::uint32_t>(code)};
  call(Operation::exit_extended, &parameters);
  for (;;) {
  }
}

}  // namespace inkwell::semihosting

// Operating system functions that newlib requires for the tests.
extern "C" {

extern char heap_start, heap_end;

int _write(int, const char* bytes, int count) {
  inkwell::semihosting::write(bytes, static_cast<std::size_t>(count));
  return count;
}

[[noreturn]] void _exit(int code) { inkwell::semihosting::exit(code); }

void* _sbrk(std::ptrdiff_t increment) {
  static char* top = &heap_start;
  if (increment > &heap_end - top) {
    inkwell::semihosting::write("The test image has no heap left; split it.\n");
    inkwell::semihosting::exit(98);
  }
  char* const block = top;
  top += increment;
  return block;
}

int _read(int, char*, int) { return 0; }
int _close(int) { return 0; }
int _isatty(int) { return 1; }
int _lseek(int, int, int) { return 0; }
int _getpid() { return 1; }
int _open(const char*, int, int) { return -1; }

int _fstat(int, struct stat* status) {
  status->st_mode = S_IFCHR;
  return 0;
}

int _kill(int, int) {
  errno = EINVAL;
  return -1;
}

// Time is not available, because tests count instructions.
int _gettimeofday(void*, void*) { return -1; }
}
