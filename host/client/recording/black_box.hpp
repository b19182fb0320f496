// A board's black box as a recording.
#pragma once

#include <span>

#include "host/client/recording/recording.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::recording {

/// Every known signal, including signals of the force law: the contents of a black box row.
std::vector<protocol::Signal> black_box_signals();

/// Converts a black box to a recording with a mark at the fault. `about` is the result of describe() for
/// black_box_signals(). The parameters in `about` are the present values, because the board does not store the earlier
/// values. Throws device::Error if there are no rows, or if the time of the rows does not increase.
Recording of_black_box(const protocol::BlackBoxReport& box, std::span<const protocol::BlackBoxRow> rows,
                       Information about);

}  // namespace inkwell::recording
