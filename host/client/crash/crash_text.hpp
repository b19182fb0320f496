// Description of a firmware crash.
#pragma once

#include <string>
#include <vector>

#include "host/client/crash/firmware_image.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::crash {

/// One sentence: the kind of fault and, if known, the affected address.
std::string cause(const protocol::CrashFacts& crash);

/// Address of the crash and return addresses of its callers, innermost first; empty if the stack could not be read. All
/// addresses after the first are guesses, because old return addresses on the stack look valid.
std::vector<std::uint32_t> chain(const protocol::CrashFacts& crash);

/// Throws device::Error unless `image` is the image that crashed.
void require_image_of(const protocol::CrashFacts& crash, const FirmwareImage& image);

/// Several lines with cause, call chain and registers. An image adds names to the call chain.
std::string text(const protocol::CrashFacts& crash, const FirmwareImage* image);

}  // namespace inkwell::crash
