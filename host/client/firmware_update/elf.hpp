// Load segments of an ELF for a 32-bit ARM.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/client/firmware_update/image.hpp"

namespace inkwell::firmware_update {

/// Returns the segments with bytes in the file, at their physical addresses. Throws NoImage.
std::vector<Segment> load_segments(std::span<const std::byte> elf, const std::string& name);

}  // namespace inkwell::firmware_update
