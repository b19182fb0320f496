// A crash of the firmware in words.
#pragma once

#include <string>
#include <vector>

#include <crash/firmware_image.hpp>
#include <protocol/black_box.hpp>

namespace inkwell::crash {

/// What kind of fault it was and, where the processor tells, which address it was about: a sentence.
std::string cause(const protocol::CrashFacts& crash);

/// Where the crash was and where the calls to there came from, the innermost first; empty if the stack could not be
/// read. Those behind the first are guesses: old return addresses on the stack look like valid ones.
std::vector<std::uint32_t> chain(const protocol::CrashFacts& crash);

/// Throws device::Error unless `image` is what ran when it crashed.
void require_image_of(const protocol::CrashFacts& crash, const FirmwareImage& image);

/// Some lines: the cause, the chain with names if there is an image, registers.
std::string text(const protocol::CrashFacts& crash, const FirmwareImage* image);

}  // namespace inkwell::crash
