#include "host/client/command_line/interrupt.hpp"

namespace inkwell::command_line {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void note_interruption(int) { interrupted = 1; }

}  // namespace

InterruptGuard::InterruptGuard() : handler_(note_interruption, static_cast<int>(SA_RESETHAND)) {}

InterruptGuard::~InterruptGuard() { interrupted = 0; }

bool InterruptGuard::is_interrupted() const { return interrupted != 0; }

}  // namespace inkwell::command_line
