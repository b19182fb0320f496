// The HDAPI error stack, shared by all threads of the program.
#pragma once

#include <string>

#include "host/bindings/dropins/constants.hpp"

namespace inkwell::dropins {

/// Pushes an error. `sentence` states the problem and the remedy; if it is empty, the text of the code is used. When
/// the stack is full, the oldest error is dropped.
void raise(ErrorCode code, Handle device, const std::string& sentence = {}, int internal_code = 0);

/// Pops and returns the newest error; returns `success` if the stack is empty.
ErrorInfo take_error();

/// Removes the errors of one device and returns whether `wanted` was among them.
bool forget_errors_of(Handle device, ErrorCode wanted = success);

/// "HD_DEVICE_FAULT: ..." with the newest sentence for this code. Never NULL; remains valid.
const char* error_text(unsigned code);

/// Returns the text at a permanent address, which is the same for equal texts.
const char* keep(const std::string& text);

}  // namespace inkwell::dropins
