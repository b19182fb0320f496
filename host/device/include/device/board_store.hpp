// What the board keeps in its flash, and the commands that change it.
#pragma once

#include <vector>

#include <device/device.hpp>
#include <protocol/store.hpp>

namespace inkwell::device {

struct BoardStore {
  protocol::StoreReport report;
  protocol::ParameterSet at_next_start;  ///< what the board's next start gives each parameter
};

BoardStore read_store(Device& device);

/// Those that would be lost with the board's power, in the table's order.
std::vector<protocol::Parameter> not_stored(const protocol::ParameterSet& held, const BoardStore& store);

/// The board did not store the parameters, or not forget them. What it kept before is unharmed.
class NotStored : public Error {
 public:
  NotStored(std::string_view what, const protocol::StoreReport& report);
  protocol::StoreReport report;
};

/// Has the board keep the parameters as it holds them now, and waits until its flash has them. Throws NotStored, with
/// the remedy, where the board refuses, as while the force is on; and Error if it takes no command.
protocol::StoreReport store_parameters(Device& device);
/// Has it forget what it keeps and gives every parameter its default. Throws likewise.
protocol::StoreReport factory_reset(Device& device);

}  // namespace inkwell::device
