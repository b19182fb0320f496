// A board's black box as a recording.
#pragma once

#include <span>

#include <protocol/black_box.hpp>
#include <recording/recording.hpp>

namespace inkwell::recording {

/// Every signal that is known, also of the force law: what a row of a black box holds.
std::vector<protocol::Signal> black_box_signals();

/// With a mark where the fault came, called by its name. `about` is what describe() says of black_box_signals(); the
/// parameters in it are those of now, for the board does not keep those of then. Throws device::Error if there are no
/// rows, or if their time does not rise.
Recording of_black_box(const protocol::BlackBoxReport& box, std::span<const protocol::BlackBoxRow> rows,
                       Information about);

}  // namespace inkwell::recording
