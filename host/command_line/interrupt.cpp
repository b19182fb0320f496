#include "interrupt.hpp"

namespace inkwell::command_line {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;

}  // namespace

InterruptGuard::InterruptGuard() {
  asked_to_end = 0;
  struct sigaction note {};
  note.sa_handler = [](int) { asked_to_end = 1; };
  note.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &note, &interrupt_before_);
  sigaction(SIGTERM, &note, &terminate_before_);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

bool InterruptGuard::was_asked_to_end() const { return asked_to_end != 0; }

}  // namespace inkwell::command_line
