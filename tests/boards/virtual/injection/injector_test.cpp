// Injects each fault of the table by name and checks the effect and the removal of the fault.
#include "boards/virtual/injection/injector.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include "boards/omni_driver/facts.hpp"

#include "tests/boards/virtual/plant/arms.hpp"

using namespace inkwell;
using namespace inkwell::virtual_board;
using protocol::InjectedFault;

namespace {

/// The chip runs a control load, and the firmware does not enable the bridges.
struct Rig {
  explicit Rig(const std::string& firmware = "servo")
      : plant(test::omni(), board::omni_driver),
        chip(wires, {.brown_out_level = 3, .log = [](const std::string&) {}}),
        injector({chip, plant, wires, 50, [this](bool in) { plugged = in; }, [this](bool asks) { host_asks = asks; }},
                 seed) {
    chip.load_elf(std::string(INKWELL_BUILD_DIRECTORY) + "/chip-firmware/" + firmware + ".elf");
    wires.connect(chip.input_pins());
    plant.connect(wires);
    chip.reset(ResetCause::power_on);
    chip.clear_counters();
    run(0.001);
  }
  /// Runs the chip in the same way as the virtual board.
  void run(double time_s) {
    const Ticks end = chip.now() + ticks(time_s);
    while (chip.now() < end) {
      if (injector.next() <= chip.now()) injector.carry_out();
      chip.run_until(std::min(end, injector.next()));
    }
    if (injector.next() <= chip.now()) injector.carry_out();
  }
  void inject(const std::string& text) { injector.add(parse_injection(text, board::omni_driver)); }
  std::uint64_t instructions_in(double time_s) {
    const auto before = chip.counters().instructions;
    run(time_s);
    return chip.counters().instructions - before;
  }
  double read_V(const board::AnalogInput& input) {
    return wires.analog_V(input.pin.port, input.pin.number, chip.now());
  }
  PinLevel level(board::Pin pin) { return chip.pin_level(pin.port, pin.number); }

  static constexpr std::uint64_t seed = 5;
  Plant plant;
  Wires wires{plant};
  Chip chip;
  bool plugged = true, host_asks = true;
  Injector injector;
};

/// Returns a valid location for each row of the table.
std::string example(const protocol::InjectionInfo& row) {
  using protocol::InjectionLocation;
  const std::string name(row.name);
  switch (row.location) {
    case InjectionLocation::motor: return name + ":2";
    case InjectionLocation::leg: return name + ":2B";
    case InjectionLocation::wire: return name + ":PB13";
    case InjectionLocation::wires: return name + ":PB13+PB14";
    case InjectionLocation::exception: return name + ":34";
    case InjectionLocation::converter: return name + ":2";
    default: return name;
  }
}

}  // namespace

TEST_CASE("every fault of the table is injected and reported with its position until it is removed") {
  for (const auto& row : protocol::injection_table) {
    CAPTURE(row.name);
    Rig rig;
    rig.inject(example(row));
    REQUIRE(rig.injector.active().size() == 1);
    const auto& active = rig.injector.active()[0];
    CHECK(protocol::info(active.injection.fault).name == row.name);
    CHECK(active.since == rig.chip.now());
    CHECK((active.injection.of.empty()) == (row.location == protocol::InjectionLocation::none));
    if (row.name != "program_astray") rig.run(0.0002);
    CHECK(rig.injector.heal(active.injection.fault, "") == 1);
    CHECK(rig.injector.active().empty());
    CHECK(rig.injector.heal(*protocol::find_injection(row.name), "") == 0);
  }
}

TEST_CASE("each injected fault has a unique number, both while it is planned and while it is active") {
  Rig rig;
  const unsigned now = rig.injector.add(parse_injection("encoder_slip:2", board::omni_driver));
  const unsigned again = rig.injector.add(parse_injection("encoder_slip:2", board::omni_driver));
  const unsigned later = rig.injector.add(parse_injection("motor_open:1@0.001", board::omni_driver));
  CHECK(again == now + 1);
  CHECK(later == again + 1);
  REQUIRE(rig.injector.planned().size() == 1);
  CHECK(rig.injector.planned()[0].number == later);
  CHECK(rig.injector.planned()[0].at == rig.chip.now() + ticks(0.001));
  rig.run(0.002);
  CHECK(rig.injector.planned().empty());
  REQUIRE(rig.injector.active().size() == 3);
  CHECK(rig.injector.active()[0].number == now);
  CHECK(rig.injector.active()[2].number == later);
}

TEST_CASE("a fault starts at its time, exact to the tick, and ends after its duration") {
  Rig rig;
  const Ticks begin = rig.chip.now();
  rig.inject("bridge_fault@0.0012345+0.0003");
  rig.run(0.0012);
  CHECK_FALSE(rig.plant.truth(rig.chip.now()).bridge_fault);
  rig.run(0.0001);
  CHECK(rig.plant.truth(rig.chip.now()).bridge_fault);
  REQUIRE(rig.injector.active().size() == 1);
  const double came_s = seconds(rig.injector.active()[0].since - begin);
  CHECK(came_s >= 0.0012345);
  CHECK(came_s < 0.0012345 + 2e-6);  // the end of an instruction or of a block of instructions
  rig.run(0.0003);
  CHECK(rig.injector.active().empty());
  CHECK_FALSE(rig.plant.truth(rig.chip.now()).bridge_fault);
}

TEST_CASE("a new wire fault replaces the earlier fault of the same wire, and faults of other wires remain") {
  Rig rig;
  rig.inject("wire_low:PB15");
  rig.inject("wire_high:PB15");
  rig.inject("wire_low:PB14");
  REQUIRE(rig.injector.active().size() == 2);
  CHECK(rig.level({'B', 15}) == PinLevel::high);
  CHECK(rig.level({'B', 14}) == PinLevel::low);
  CHECK(rig.injector.heal(InjectedFault::wire_low, "button_1") == 0);
  CHECK(rig.injector.heal(InjectedFault::wire_low, "button_2") == 1);
  rig.inject("supply_cut@1");
  rig.injector.heal_all();
  CHECK(rig.injector.active().empty());
  CHECK(rig.injector.next() == ~Ticks{0});
  CHECK(rig.level({'B', 15}) == PinLevel::low);  // the inkwell switch is closed
}

TEST_CASE("wires") {
  Rig rig;
  const board::Pin fault_wire = board::omni_driver.bridge_fault_tim1.pin;
  REQUIRE(rig.level(fault_wire) == PinLevel::high);
  rig.inject("wire_low:bridge_fault_tim1");
  CHECK(rig.level(fault_wire) == PinLevel::low);
  rig.inject("wire_open:bridge_fault_tim1");
  CHECK(rig.level(fault_wire) == PinLevel::floating);
  rig.inject("wire_frozen:PB12");
  rig.inject("bridge_fault");
  rig.run(0.0002);
  CHECK(rig.level(fault_wire) == PinLevel::high);  // the level at the time of the freeze
  CHECK(rig.level(board::omni_driver.bridge_fault_tim8.pin) == PinLevel::low);
  rig.inject("wire_high:PB12");
  CHECK(rig.level(fault_wire) == PinLevel::high);
  rig.inject("wire_frozen:PB12");
  rig.injector.heal_all();
  rig.run(0.0002);
  rig.inject("wires_shorted:PB12+PB15");
  CHECK(rig.level(fault_wire) == PinLevel::low);  // from the inkwell switch
  rig.injector.heal_all();
  CHECK(rig.level(fault_wire) == PinLevel::high);
}

TEST_CASE("spikes have the requested rate and stop after the fault is healed") {
  Rig rig;
  unsigned rises = 0;
  rig.chip.watch_pins([&](char port, unsigned pin, PinLevel level, Ticks) {
    rises += port == 'B' && pin == 15 && level == PinLevel::high;
  });
  rises = 0;
  rig.inject("wire_spikes:PB15=20000");
  rig.run(0.02);
  CHECK(rises > 320);
  CHECK(rises < 480);
  rig.injector.heal_all();
  rig.run(0.0001);
  rises = 0;
  rig.run(0.01);
  CHECK(rises == 0);
}

TEST_CASE("encoders, shunts and motors by their numbers") {
  Rig rig;
  const double zero_V = rig.read_V(board::omni_driver.motor_current[1]);
  rig.inject("shunt_offset:2=1");
  CHECK(rig.read_V(board::omni_driver.motor_current[1]) - zero_V == doctest::Approx(0.4).epsilon(0.02));
  rig.inject("shunt_high:2");
  CHECK(rig.read_V(board::omni_driver.motor_current[1]) == doctest::Approx(3.1));
  rig.inject("shunt_low:2");
  CHECK(rig.read_V(board::omni_driver.motor_current[1]) == doctest::Approx(0.2));
  rig.injector.heal(InjectedFault::shunt_low, "2");
  rig.inject("shunt_gain:2=3");
  CHECK(rig.plant.shunt_fault(1).gain == 3.0);
  CHECK(rig.plant.shunt_fault(1).offset_A == 1.0);
  CHECK(rig.plant.shunt_fault(1).output == ShuntFault::Output::follows);
  rig.inject("shunt_frozen:2");
  CHECK(rig.read_V(board::omni_driver.motor_current[1]) == rig.read_V(board::omni_driver.motor_current[1]));
  rig.injector.heal_all();
  CHECK(rig.read_V(board::omni_driver.motor_current[1]) == doctest::Approx(zero_V).epsilon(0.005));

  rig.inject("motor_open:1");
  rig.inject("motor_shorted:2=0.25");
  rig.inject("motor_hot:3=50");
  CHECK(rig.plant.motor_fault(0).open);
  CHECK(rig.plant.motor_fault(1).turns_left == 0.25);
  CHECK(rig.plant.motor_fault(2).warmer_K == 50.0);
  rig.injector.heal_all();
  CHECK_FALSE(rig.plant.motor_fault(0).open);
  CHECK(rig.plant.motor_fault(1).turns_left == 1.0);
  CHECK(rig.plant.motor_fault(2).warmer_K == 0.0);

  const auto turn = [&] {
    rig.plant.place({-0.4, 0.8, 0.4}, {10.0, 0.0, 0.0});
    rig.run(0.0002);
    int edges = 0;
    rig.chip.watch_pins([&](char port, unsigned pin, PinLevel, Ticks) { edges += port == 'A' && pin <= 1; });
    edges = 0;
    rig.run(0.01);
    return edges;
  };
  const int healthy = turn();
  CHECK(healthy > 20);
  rig.inject("encoder_stuck:1");
  CHECK(turn() == 0);
  rig.injector.heal_all();
  rig.inject("encoder_lost_counts:1=0.5");
  CHECK(turn() < 0.9 * healthy);
  rig.injector.heal_all();
  rig.inject("encoder_slip:1=4000");  // 20 counts per step of the arm, so the slip takes 3.3 ms
  CHECK(turn() > healthy + 3500);
}

TEST_CASE("more faults than the maximum are refused until faults are healed") {
  Rig rig;
  for (std::size_t i = 0; i < Injector::faults_maximum; ++i) rig.inject("supply_sag=9@1000");
  CHECK_THROWS_AS(rig.inject("supply_sag=9@1000"), InvalidInjection);
  CHECK_THROWS_AS(rig.inject("motor_open:1"), InvalidInjection);
  rig.injector.heal_all();
  CHECK_NOTHROW(rig.inject("motor_open:1"));
}

TEST_CASE("legs of bridges by motor and terminal") {
  Rig rig("converters");  // does not drive the bridges
  const auto drive = [&](board::Pin pin, bool high) {
    rig.wires.output_changed(pin.port, pin.number, high ? PinLevel::high : PinLevel::low, rig.chip.now());
  };
  const auto enable = [&](bool on) { drive(board::omni_driver.bridge_enable, on); };
  const auto run_on = [&](double time_s) {  // with heartbeat pulses
    for (double left_s = time_s; left_s > 0; left_s -= 50e-6) {
      for (const bool high : {true, false}) drive(board::omni_driver.bridge_heartbeat, high);
      rig.run(50e-6);
    }
  };
  const auto trips = [&](const std::string& fault) {
    rig.inject(fault);
    enable(true);
    run_on(0.0005);
    const bool tripped = rig.plant.truth(rig.chip.now()).bridge_fault;
    enable(false);
    rig.injector.heal_all();
    return tripped;
  };
  CHECK(trips("leg_high:2B"));
  const auto& leg_a = board::omni_driver.bridges[0].leg_a.pin;
  drive(leg_a, true);
  CHECK(trips("leg_low:1A"));
  CHECK_FALSE(trips("leg_high:1A"));
  drive(leg_a, false);
  CHECK_FALSE(trips("leg_open:3A"));
  CHECK_FALSE(trips("leg_slow:3A=0.00002"));

  // Step response of the voltage across motor 3.
  const auto risen_A = [&](const std::string& fault) {
    if (!fault.empty()) rig.inject(fault);
    enable(true);
    run_on(0.0001);
    const auto& leg = board::omni_driver.bridges[2].leg_a.pin;
    drive(leg, true);
    run_on(0.00005);
    const double current_A = rig.plant.truth(rig.chip.now()).current_A[2];
    enable(false);
    drive(leg, false);
    rig.run(0.0005);
    rig.injector.heal_all();
    return current_A;
  };
  const double healthy_A = risen_A("");
  CHECK(healthy_A > 1.0);
  CHECK(risen_A("leg_open:3A") == 0.0);
  CHECK(risen_A("leg_slow:3A=0.00002") < 0.75 * healthy_A);
  CHECK(risen_A("leg_slow:3A=0.00005") < 0.05 * healthy_A);
  CHECK(risen_A("leg_slow:3B=0.00005") == doctest::Approx(healthy_A).scale(0).epsilon(0.02));
  CHECK(risen_A("") == doctest::Approx(healthy_A).scale(0).epsilon(0.02));
}

TEST_CASE("supplies") {
  Rig rig;
  const auto bus_V = [&] { return rig.plant.truth(rig.chip.now()).supply_V; };
  rig.inject("supply_spike=25+0.005");
  rig.run(0.004);
  CHECK(bus_V() == doctest::Approx(25.0).epsilon(0.01));
  rig.run(0.002);
  CHECK(bus_V() < 25.0);
  rig.inject("supply_cut");
  rig.run(0.1);
  const double falling_V = bus_V();
  rig.inject("supply_sag=10");
  rig.run(0.1);
  CHECK(bus_V() < 0.9 * falling_V);
  rig.injector.heal_all();
  rig.run(0.01);
  CHECK(bus_V() == doctest::Approx(18.0).epsilon(0.01));

  const auto swing_V = [&] {
    double lowest_V = 99.0, highest_V = 0.0;
    for (int i = 0; i < 20; ++i) {
      rig.run(0.0005);
      lowest_V = std::min(lowest_V, bus_V());
      highest_V = std::max(highest_V, bus_V());
    }
    return highest_V - lowest_V;
  };
  rig.inject("supply_ripple=2");
  CHECK(swing_V() == doctest::Approx(4.0).epsilon(0.05));
  rig.injector.heal_all();
  rig.run(0.3);
  CHECK(swing_V() < 0.1);

  const auto wiper_V = [&] { return rig.read_V(board::omni_driver.gimbal[0]); };
  for (const char* fault : {"analog_sag=3", "logic_sag=3"}) {
    rig.inject(fault);
    CHECK(wiper_V() == doctest::Approx(1.5).epsilon(0.01));
  }
  CHECK(rig.injector.active().size() == 1);  // the new fault replaces the old one
  rig.injector.heal_all();
  CHECK(wiper_V() == doctest::Approx(1.65).epsilon(0.01));

  rig.inject("logic_sag=2@0.001+0.001");
  rig.run(0.0015);
  CHECK(rig.chip.counters().resets[static_cast<std::size_t>(ResetCause::brown_out)] == 1);
  CHECK(rig.instructions_in(0.0002) == 0);
  rig.run(0.0005);
  CHECK(rig.instructions_in(0.0005) > 0);

  // A new amount leaves the fault active, so the supply remains low.
  const auto brown_outs = [&] { return rig.chip.counters().resets[static_cast<std::size_t>(ResetCause::brown_out)]; };
  const auto before = brown_outs();
  for (const char* fault : {"logic_sag=2", "logic_sag=1.9"}) {
    rig.inject(fault);
    rig.run(0.0005);
    CHECK(brown_outs() == before + 1);
  }
}

TEST_CASE("crystal, cable and host") {
  Rig rig;
  rig.inject("crystal_drift=-5000");
  CHECK(rig.chip.clocks().hclk_Hz == 167'160'000);
  rig.injector.heal_all();
  CHECK(rig.chip.clocks().hclk_Hz == 168'008'400);  // the original 50 ppm remain
  rig.inject("crystal_stop");
  CHECK(rig.instructions_in(0.001) == 0);
  rig.injector.heal_all();
  CHECK(rig.instructions_in(0.01) > 0);
  rig.inject("usb_cut+0.001");
  CHECK_FALSE(rig.plugged);
  rig.inject("host_silent+0.001");
  CHECK_FALSE(rig.host_asks);
  rig.run(0.0011);
  CHECK(rig.plugged);
  CHECK(rig.host_asks);
}

TEST_CASE("the core that stands, interrupts that stay away or come late, converters and DMA that stop") {
  for (const char* fault : {"core_stalled=10", "core_halted=10"}) {
    CAPTURE(fault);
    Rig rig;
    rig.inject(fault);
    CHECK(rig.instructions_in(0.001) == 0);
    rig.injector.heal_all();
    CHECK(rig.instructions_in(0.001) > 1000);
  }
  const auto handled = [](Rig& rig) {
    const auto before = rig.chip.memory_word(0x2001F004);  // counter of the firmware's handler
    rig.run(0.001);
    return rig.chip.memory_word(0x2001F004) - before;
  };
  for (const char* fault : {"exception_lost:34", "adc_stopped:1"}) {
    CAPTURE(fault);
    Rig rig;
    CHECK(handled(rig) >= 19);
    rig.inject(fault);
    handled(rig);
    CHECK(handled(rig) == 0);
    rig.injector.heal_all();
    CHECK(handled(rig) >= 18);
  }
  Rig stalled;
  const auto looped = [&stalled] { return stalled.chip.memory_word(0x2001F008); };  // counter of its main loop
  stalled.inject("main_loop_stalled=10");
  const auto before = looped();
  CHECK(handled(stalled) >= 19);
  CHECK(looped() == before);
  stalled.injector.heal_all();
  CHECK(handled(stalled) >= 18);
  CHECK(looped() > before + 1000);
  const auto between = looped();
  stalled.inject("main_loop_stalled=0.0005");
  CHECK(handled(stalled) >= 19);
  CHECK(looped() > between + 400);
  CHECK(looped() < between + 800);  // of 1200 in a whole millisecond
  Rig late;
  late.inject("exception_late:34=12600");  // one and a half periods, so that every second interrupt falls into the next
                                           // period
  CHECK(handled(late) < 15);
  Rig dma("converters");
  dma.run(0.002);
  dma.inject("dma_stopped");
  const auto filled = dma.chip.memory_word(0x2001F018);
  CHECK(filled > 0);
  dma.run(0.002);
  CHECK(dma.chip.memory_word(0x2001F018) == filled);
}

TEST_CASE("bits and the program counter, at an address or by the seed") {
  Rig rig;
  rig.inject("ram_bit:0x2001EF01=3");
  CHECK((rig.chip.memory_word(0x2001'EF00) >> 11 & 1) == 1);
  rig.injector.heal_all();  // does not undo a change that has already happened
  CHECK((rig.chip.memory_word(0x2001'EF00) >> 11 & 1) == 1);
  const std::uint32_t before = rig.chip.memory_word(0x0800'0000);
  rig.inject("flash_bit:0x08000000=0");
  CHECK(rig.chip.memory_word(0x0800'0000) == (before ^ 1));
  rig.injector.heal_all();
  CHECK(rig.chip.memory_word(0x0800'0000) == before);

  const auto chosen = [](const std::string& fault) {
    Rig other;
    other.inject(fault);
    return other.injector.active()[0].injection;
  };
  for (const std::string fault : {"ram_bit", "flash_bit"}) {
    CHECK(chosen(fault).address == chosen(fault).address);
    CHECK(chosen(fault).amount >= 0.0);
  }
  CHECK(chosen("flash_bit").address.value() - 0x0800'0000 < 0x4000);  // within the image
  rig.inject("program_astray:0x08000101");
  CHECK(rig.injector.active()[0].injection.address == 0x0800'0100u);

  CHECK_THROWS_WITH_AS(rig.inject("flash_bit:0x20000000"), doctest::Contains("there is no flash at 0x20000000"),
                       InvalidInjection);
  CHECK_THROWS_WITH_AS(rig.inject("ram_bit:0x60000000"), doctest::Contains("there is no memory at 0x60000000"),
                       InvalidInjection);
}
