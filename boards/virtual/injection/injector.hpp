// Applies injected faults to the chip and the plant at the requested times, and clears the faults.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "boards/stm32f405/wiring/chip.hpp"
#include "boards/virtual/injection/injection.hpp"
#include "boards/virtual/plant/plant.hpp"
#include "boards/virtual/plant/wires.hpp"

namespace inkwell::virtual_board {

class Injector {
 public:
  struct Victims {
    Chip& chip;
    Plant& plant;
    Wires& wires;
    std::int32_t crystal_ppm = 0;                      ///< offset of the crystal without drift
    std::function<void(bool in)> plug;                 ///< the USB cable
    std::function<void(bool polls)> set_host_polling;  ///< see VirtualUsb
  };
  struct Active {
    unsigned number;      ///< see add()
    Injection injection;  ///< with the address and bit chosen from the seed
    Ticks since;
    std::optional<Ticks> until;
  };

  struct Planned {
    unsigned number;
    Injection injection;
    Ticks at;
  };

  /// Largest number of active and planned faults together.
  static constexpr std::size_t faults_maximum = 10'000;

  Injector(Victims victims, std::uint64_t seed) : victims_(std::move(victims)), random_(seed) {}

  /// Applies the fault after `after_s` (see next()). Replaces a fault of the same kind at the same location. Throws
  /// InvalidInjection if no memory exists at the address, or if `faults_maximum` is reached. Do not call this function
  /// inside Chip::run_until(). Returns a unique number for the fault.
  unsigned add(Injection injection);
  /// Returns the time of the next start or end of a fault. At this time the board calls carry_out().
  Ticks next() const;
  void carry_out();

  /// Clears active faults and cancels planned faults of this kind at location `of`. An empty `of` means all locations.
  /// Returns the number of cleared and canceled faults. The effect of a momentary fault remains.
  unsigned heal(protocol::InjectedFault fault, const std::string& of);
  void heal_all();

  /// Active faults in the order of their start times.
  const std::vector<Active>& active() const { return active_; }
  /// Planned faults in the order of their requests.
  const std::vector<Planned>& planned() const { return planned_; }

 private:
  void put_in(unsigned number, Injection injection);
  void choose_address(Injection& injection);
  void put(const Injection& injection, bool in);
  void put_into_wire(const Injection& injection, bool in);
  void put_into_motor(const Injection& injection, bool in);
  void put_into_chip(const Injection& injection, bool in);
  void spike(const std::weak_ptr<double>& rate, PinName wire);

  Victims victims_;
  std::mt19937_64 random_;
  unsigned last_number_ = 0;
  std::vector<Planned> planned_;
  std::vector<Active> active_;
  struct Spikes {
    PinName wire;
    std::shared_ptr<double> rate_Hz;  ///< the spikes stop when this object is destroyed
  };
  std::vector<Spikes> spikes_;
};

}  // namespace inkwell::virtual_board
