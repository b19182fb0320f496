// Puts faults into the chip and what surrounds it, at their times, and takes them out again.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <chip/chip.hpp>
#include <injection/injection.hpp>
#include <plant/plant.hpp>
#include <plant/wires.hpp>

namespace inkwell::virtual_board {

class Injector {
 public:
  struct Victims {
    Chip& chip;
    Plant& plant;
    Wires& wires;
    std::int32_t crystal_ppm = 0;                 ///< of a crystal that does not drift
    std::function<void(bool in)> plug;            ///< the USB cable
    std::function<void(bool asks)> let_host_ask;  ///< see VirtualUsb
  };
  /// A fault that is in, or has happened.
  struct Active {
    unsigned number;      ///< see add()
    Injection injection;  ///< with the place and the bit that the seed chose
    Ticks since;
    std::optional<Ticks> until;
  };

  /// One that is still to come.
  struct Planned {
    unsigned number;
    Injection injection;
    Ticks at;
  };

  /// In and still to come.
  static constexpr std::size_t faults_maximum = 10'000;

  Injector(Victims victims, std::uint64_t seed) : victims_(std::move(victims)), random_(seed) {}

  /// At once, or when its time has come: see next(). Takes the place of one of its kind at the same place. Throws
  /// InvalidInjection if there is nothing at its address, or if it would be one too many. Not from inside
  /// Chip::run_until(). Returns a number that identifies it, also among others with the same name and position.
  unsigned add(const Injection& injection);
  /// When something is to be done, at the earliest. The board runs as far, then calls carry_out().
  Ticks next() const;
  void carry_out();

  /// Takes out what is in under this name and place (any, if empty), and forgets what is still to come. Says how many
  /// there were. What has happened stays so, but is no longer told.
  unsigned heal(protocol::InjectedFault fault, const std::string& of);
  void heal_all();

  /// In the order in which they came.
  const std::vector<Active>& active() const { return active_; }
  /// In the order in which they were asked for.
  const std::vector<Planned>& planned() const { return planned_; }

 private:
  void put_in(unsigned number, Injection injection);
  void choose_place(Injection& injection);
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
    std::shared_ptr<double> rate_Hz;  ///< spikes come as long as it lives
  };
  std::vector<Spikes> spikes_;
};

}  // namespace inkwell::virtual_board
