// Load segments of an ELF for a 32-bit ARM.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

/// The segments that have bytes in the file, at their physical addresses. Throws NoImage.
std::vector<Segment> load_segments(std::span<const std::byte> elf, const std::string& name);

}  // namespace inkwell::firmware_update
