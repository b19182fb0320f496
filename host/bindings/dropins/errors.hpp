// The HDAPI error stack, shared by all threads of the program.
#pragma once

#include <string>

#include "host/bindings/dropins/constants.hpp"

namespace inkwell::dropins {

/// Pushes an error. `sentence` states the problem and the remedy. An empty `sentence` selects the standard text of the
/// code. When the stack is full, the oldest error is dropped.
void raise(ErrorCode code, Handle device, const std::string& sentence = {}, int internal_code = 0);

/// Pops and returns the newest error; returns `success` if the stack is empty.
ErrorInfo take_error();

/// Removes all errors of one device, and returns true if one of the errors was `wanted`.
bool forget_errors_of(Handle device, ErrorCode wanted = success);

/// Returns a text such as "HD_DEVICE_FAULT: ..." with the newest sentence for this code. The text is never NULL and
/// remains valid.
const char* error_text(unsigned code);

/// Returns a permanent copy of the text. Equal texts share one copy.
const char* keep(const std::string& text);

}  // namespace inkwell::dropins
