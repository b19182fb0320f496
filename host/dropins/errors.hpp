// HDAPI's errors: one stack for all threads of the program, the newest on top.
#pragma once

#include <string>

#include "constants.hpp"

namespace inkwell::dropins {

/// Puts an error on the stack. `sentence` says what is wrong and what to do; without one the code's own text stands.
/// A program that never looks loses the oldest.
void raise(ErrorCode code, Handle device, const std::string& sentence = {}, int internal_code = 0);

/// Takes the newest off; `success` when there is none.
ErrorInfo take_error();

/// Takes those of one device off that were raised before, and tells whether `looked_for` was among them.
bool forget_errors_of(Handle device, ErrorCode looked_for = success);

/// "HD_DEVICE_FAULT: ..." with the newest sentence that was raised under this code. Never NULL; stays valid.
const char* error_text(unsigned code);

/// The same text each time at the same place, for as long as the program runs.
const char* keep(const std::string& text);

}  // namespace inkwell::dropins
