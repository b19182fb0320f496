// Reads and changes the stored parameters of the board.
#pragma once

#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/store.hpp"

namespace inkwell::device {

struct BoardStore {
  protocol::StoreReport report;
  protocol::ParameterSet at_next_start;  ///< parameter values after the next start of the board
};

BoardStore read_store(Device& device);

/// Returns the parameters whose current values differ from their stored values.
std::vector<protocol::Parameter> not_stored(const protocol::ParameterSet& held, const BoardStore& store);

/// The board did not store or erase the parameters. The previously stored parameters are intact.
class NotStored : public Error {
 public:
  NotStored(std::string_view what, const protocol::StoreReport& report);
  protocol::StoreReport report;
};

/// Stores the current parameters and waits until they are in flash memory. Throws NotStored with the remedy if the
/// board refuses the command. Throws Error if the board does not execute the command.
protocol::StoreReport store_parameters(Device& device);
/// Erases the stored parameters and sets every parameter to its default. Throws NotStored or Error like
/// store_parameters().
protocol::StoreReport factory_reset(Device& device);

}  // namespace inkwell::device
