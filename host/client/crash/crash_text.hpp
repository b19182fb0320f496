// Description of a firmware crash.
#pragma once

#include <string>
#include <vector>

#include "host/client/crash/firmware_image.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::crash {

/// Returns one sentence with the kind of CPU fault and, if known, the affected address.
std::string cause(const protocol::CrashFacts& crash);

/// Returns the crash address and then the return addresses, innermost first. The return addresses are guesses, because
/// old return addresses on the stack look valid. Returns an empty list if the board could not read the stack.
std::vector<std::uint32_t> chain(const protocol::CrashFacts& crash);

/// Throws device::Error if the crash occurred in another image.
void require_image_of(const protocol::CrashFacts& crash, const FirmwareImage& image);

/// Returns several lines with cause, call chain and registers. The lines contain function names if `image` is given.
std::string text(const protocol::CrashFacts& crash, const FirmwareImage* image);

}  // namespace inkwell::crash
