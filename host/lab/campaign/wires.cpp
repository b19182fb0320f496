#include "host/lab/campaign/wires.hpp"

namespace inkwell::campaign {

Wire wire_of(std::string_view name) {
  constexpr struct {
    std::string_view begin;
    Wire wire;
  } names[] = {{"encoders[", Wire::encoder},
               {"bridges[", Wire::bridge_leg},
               {"bridge_fault_tim1", Wire::bridge_fault_tim1},
               {"bridge_fault_tim8", Wire::bridge_fault_tim8},
               {"bridge_enable", Wire::bridge_enable},
               {"bridge_heartbeat", Wire::bridge_heartbeat},
               {"bridge_hold", Wire::bridge_hold},
               {"motor_current[", Wire::motor_current},
               {"gimbal[", Wire::gimbal},
               {"supply", Wire::supply},
               {"usb_supply", Wire::usb_supply},
               {"button_", Wire::button},
               {"inkwell_switch", Wire::inkwell_switch}};
  for (const auto& known : names)
    if (name.starts_with(known.begin)) return known.wire;
  return Wire::other;
}

}  // namespace inkwell::campaign
