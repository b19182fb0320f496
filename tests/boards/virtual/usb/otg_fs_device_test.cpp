// Tests the registers of the USB core against RM0090, and the violations that the core reports.
#include <doctest/doctest.h>

#include <array>

#include "tests/boards/virtual/usb/fake_board.hpp"
#include "tests/boards/virtual/usb/fake_firmware.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using virtual_board::Handshake;
using virtual_board::InReply;
using virtual_board::OtgFsDevice;

constexpr std::uint32_t gahbcfg = 0x008, grstctl = 0x010, gintsts = 0x014, gintmsk = 0x018, grxstsr = 0x01C,
                        grxstsp = 0x020, gccfg = 0x038, dctl = 0x804, dsts = 0x808, dcfg = 0x800;
constexpr std::uint32_t sof = 1u << 3, rxflvl = 1u << 4, ginakeff = 1u << 6, gonakeff = 1u << 7;
constexpr std::uint32_t epena = 1u << 31, epdis = 1u << 30, snak = 1u << 27, cnak = 1u << 26, naksts = 1u << 17,
                        stall = 1u << 21;
constexpr std::array<std::byte, 8> some_request{};

struct CoreBench {
  CoreBench() : core({scheduler, interrupts, log, log, state, triggers}), firmware(core, scheduler) {
    core.set_bus_power(true);
    firmware.start();
    core.begin_reset();
    core.end_reset();
    firmware.handle_interrupt();
    write(gintmsk, 0);  // from here on the tests are the driver
  }
  std::uint32_t read(std::uint32_t offset) { return core.read(offset, 4); }
  void write(std::uint32_t offset, std::uint32_t value) { core.write(offset, value, 4); }
  void wait_us(double time_us) { scheduler.run_until(scheduler.now() + virtual_board::ticks(time_us * 1e-6)); }
  InReply in(unsigned endpoint) { return core.in(0, endpoint, packet); }
  /// Activates bulk endpoints 0x82 and 0x03, like SET_CONFIGURATION.
  void activate() {
    write(0x940, 1u << 28 | 2u << 22 | 2u << 18 | 1u << 15 | 64);
    write(0xB60, 1u << 28 | 2u << 18 | 1u << 15 | 64);
  }
  Handshake out(unsigned endpoint, bool data1, std::size_t length) {
    return core.out(0, endpoint, data1, std::span(packet).first(length));
  }

  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  OtgFsDevice core;
  FakeFirmware firmware;
  std::array<std::byte, virtual_board::full_speed_packet_maximum> packet{};
};

TEST_CASE("reset values") {
  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  OtgFsDevice core({scheduler, interrupts, log, log, state, triggers});
  const std::array<std::pair<std::uint32_t, std::uint32_t>, 16> expected{{{0x008, 0},
                                                                          {0x00C, 0x0A00},
                                                                          {0x010, 0x8000'0000},
                                                                          {0x014, 0x0400'0020},
                                                                          {0x018, 0},
                                                                          {0x024, 0x200},
                                                                          {0x028, 0x0200'0200},
                                                                          {0x03C, 0x1200},
                                                                          {0x040, 0x4F54'281A},
                                                                          {0x104, 0x0200'0400},
                                                                          {0x800, 0x0220'0000},
                                                                          {0x804, 0},
                                                                          {0x828, 0x17D7},
                                                                          {0x82C, 0x05B8},
                                                                          {0x900, 0x8000},
                                                                          {0xB00, 0x8000}}};
  for (const auto& row : expected) {
    CAPTURE(row.first);
    CHECK(core.read(row.first, 4) == row.second);
  }
  CHECK(log.sentences.empty());
  core.read(0x440, 4);
  CHECK(log.sentences.size() == 1);
}

TEST_CASE("the pull-up needs power, a session and no soft disconnect") {
  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  OtgFsDevice core({scheduler, interrupts, log, log, state, triggers});
  CHECK(core.attachment() == 0);
  core.write(gccfg, 1u << 16, 4);
  CHECK(core.attachment() == 0);  // VBUS is not sensed
  core.write(gccfg, 1u << 16 | 1u << 19, 4);
  CHECK(core.attachment() == 0);  // VBUS sensing is on, and VBUS is absent
  core.set_bus_power(true);
  CHECK(core.attachment() != 0);
  core.set_bus_power(false);
  CHECK(core.attachment() == 0);
  CHECK((core.read(0x004, 4) & 1u << 2) != 0);  // session end detected
  core.write(gccfg, 1u << 16 | 1u << 21, 4);
  const std::uint32_t first = core.attachment();
  CHECK(first != 0);
  core.write(dctl, 2, 4);
  CHECK(core.attachment() == 0);
  core.write(dctl, 0, 4);
  CHECK(core.attachment() != first);
}

TEST_CASE("a pull-up without VBUS is reported immediately when it is connected, and ten seconds after a VBUS loss") {
  CoreBench bench;
  bench.core.set_bus_power(false);
  bench.wait_us(9.9e6);
  CHECK(bench.log.sentences.empty());
  SUBCASE("it stays") {
    bench.wait_us(0.2e6);
    CHECK(bench.log.has("supplies no VBUS"));
  }
  SUBCASE("the pull-up is removed in time") {
    bench.write(dctl, 2);
    bench.wait_us(0.2e6);
    CHECK(bench.log.sentences.empty());
    bench.write(dctl, 0);
    CHECK(bench.log.has("supplies no VBUS"));
  }
  SUBCASE("VBUS returns") {
    bench.core.set_bus_power(true);
    bench.wait_us(0.2e6);
    CHECK(bench.log.sentences.empty());
  }
}

TEST_CASE("the interrupt line follows status, mask and the global switch") {
  CoreBench bench;
  bench.write(gintsts, 0xFFFF'FFFF);
  bench.core.start_of_frame(0x7A5);
  CHECK_FALSE(bench.interrupts.asserted());
  bench.write(gintmsk, sof);
  CHECK(bench.interrupts.asserted());
  CHECK(bench.interrupts.position() == 67);
  bench.write(gahbcfg, 0);
  CHECK_FALSE(bench.interrupts.asserted());
  bench.write(gahbcfg, 1);
  CHECK(bench.interrupts.asserted());
  bench.write(gintsts, sof);
  CHECK_FALSE(bench.interrupts.asserted());
  CHECK((bench.read(dsts) >> 8 & 0x3FFF) == 0x7A5);
}

TEST_CASE("a SETUP packet is taken against NAK and STALL, clears the stall and sets NAK") {
  CoreBench bench;
  bench.write(0x900, stall | snak);
  bench.write(0xB00, stall | snak);
  CHECK(bench.in(0).handshake == Handshake::stall);
  CHECK(bench.out(0, true, 0) == Handshake::stall);
  CHECK(bench.core.setup(0, 0, some_request) == Handshake::ack);
  CHECK((bench.read(0x900) & (stall | naksts)) == naksts);
  CHECK((bench.read(0xB00) & (stall | naksts)) == naksts);
  CHECK((bench.read(gintsts) & rxflvl) != 0);
  CHECK((bench.read(grxstsr) >> 17 & 15) == 6);
  const std::uint32_t status = bench.read(grxstsp);
  CHECK((status >> 17 & 15) == 6);
  CHECK((status >> 4 & 0x7FF) == 8);
  bench.read(0x1000);
  bench.read(0x1000);
  CHECK((bench.read(gintsts) & rxflvl) == 0);  // the next token writes the setup-done word
  CHECK(bench.in(0).handshake == Handshake::nak);
  CHECK((bench.read(grxstsp) >> 17 & 15) == 4);
  CHECK((bench.read(0xB08) & 1u << 3) != 0);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("back-to-back SETUP packets all arrive, four exceed the count") {
  CoreBench bench;
  for (int i = 0; i < 4; ++i) CHECK(bench.core.setup(0, 0, some_request) == Handshake::ack);
  CHECK((bench.read(0xB08) & 1u << 6) != 0);
  for (int i = 0; i < 4; ++i) {
    CHECK((bench.read(grxstsp) >> 17 & 15) == 6);
    bench.read(0x1000);
    bench.read(0x1000);
  }
}

TEST_CASE(
    "clearing NAK after a SETUP packet loses the setup-done word, and breaks a rule only if the firmware could see the "
    "packet") {
  const auto clear_nak = [](bool sees, double time_since_look_us) {
    CoreBench bench;
    bench.read(gintsts);
    bench.wait_us(time_since_look_us);
    bench.core.setup(0, 0, some_request);
    if (sees) bench.read(gintsts);
    bench.write(0xB00, epena | cnak);
    CHECK((bench.read(0xB00) & naksts) == 0);
    bench.read(grxstsp);
    for (int i = 0; i < 2; ++i) bench.read(0x1000);
    bench.in(0);
    CHECK((bench.read(gintsts) & rxflvl) == 0);  // position of the setup-done word
    return !bench.log.broken.empty();
  };
  CHECK_FALSE(clear_nak(false, 0.5));
  CHECK(clear_nak(true, 0.5));
  CHECK(clear_nak(false, 5.0));
}

TEST_CASE("a new address holds from the end of the status stage") {
  CoreBench bench;
  bench.core.setup(0, 0, some_request);
  bench.write(dcfg, bench.read(dcfg) | 9u << 4);
  bench.core.in(0, 0, bench.packet);  // completes the setup stage
  while ((bench.read(gintsts) & rxflvl) != 0)
    if ((bench.read(grxstsp) >> 4 & 0x7FF) == 8) bench.read(0x1000), bench.read(0x1000);
  bench.write(0x910, 1u << 19);
  bench.write(0x900, epena | cnak);
  CHECK(bench.core.in(0, 0, bench.packet).handshake == Handshake::ack);
  CHECK(bench.core.finish_in(0));
  CHECK(bench.core.in(0, 0, bench.packet).handshake == Handshake::nothing);
  CHECK(bench.core.in(9, 0, bench.packet).handshake == Handshake::nak);
}

TEST_CASE("IN: NAK until the whole packet is loaded, then data with alternating toggles") {
  CoreBench bench;
  bench.activate();
  CHECK(bench.in(2).handshake == Handshake::nak);
  bench.write(0x950, 2u << 19 | 70);
  bench.write(0x940, bench.read(0x940) | epena | cnak);
  const std::uint32_t free_words = bench.read(0x958);
  CHECK(free_words == 128);
  for (int i = 0; i < 15; ++i) bench.core.write(0x3000, 0x0403'0201, 4);
  CHECK(bench.core.in(0, 2, bench.packet).handshake == Handshake::nak);
  for (int i = 0; i < 3; ++i) bench.core.write(0x3000, 0x0807'0605, 4);
  const InReply first = bench.in(2);
  CHECK(first.handshake == Handshake::ack);
  CHECK(first.length == 64);
  CHECK_FALSE(first.data1);
  CHECK(bench.packet[63] == std::byte{8});
  CHECK(bench.in(2).length == 64);  // not acknowledged: the packet is repeated
  CHECK(bench.core.finish_in(2));
  CHECK((bench.read(0x948) & 1) == 0);
  const InReply second = bench.in(2);
  CHECK(second.length == 6);
  CHECK(second.data1);
  CHECK(bench.core.finish_in(2));
  CHECK((bench.read(0x948) & 1) != 0);
  CHECK((bench.read(0x940) & epena) == 0);
  CHECK(bench.read(0x958) == 128);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("NAK and a disable wait for the packet on the wire, a flush spoils it") {
  CoreBench bench;
  bench.activate();
  bench.write(0x950, 2u << 19 | 68);
  bench.write(0x940, bench.read(0x940) | epena | cnak);
  for (int i = 0; i < 17; ++i) bench.core.write(0x3000, 1, 4);
  constexpr std::uint32_t epdisd = 1u << 1, inepne = 1u << 6;
  const auto flags = [&] { return bench.read(0x948) & (epdisd | inepne); };
  CHECK(bench.in(2).handshake == Handshake::ack);
  bench.write(0x940, bench.read(0x940) | snak);
  bench.wait_us(40);  // of 51
  CHECK(flags() == 0);
  SUBCASE("acknowledged") {
    bench.write(0x940, bench.read(0x940) | epdis | snak);
    CHECK(bench.core.finish_in(2));
    bench.wait_us(12);
    CHECK(flags() == (epdisd | inepne));
    CHECK((bench.read(0x940) & epena) == 0);
    CHECK(bench.read(0x958) == 127);
    CHECK(bench.log.sentences.empty());
  }
  SUBCASE("not acknowledged") {
    bench.write(0x940, bench.read(0x940) | epdis | snak);
    CHECK(bench.in(2).handshake == Handshake::nak);
    bench.wait_us(12);
    CHECK(flags() == (epdisd | inepne));
    CHECK(bench.read(0x958) == 111);
    CHECK_FALSE(bench.core.finish_in(2));
    CHECK(bench.log.sentences.empty());
  }
  SUBCASE("flushed under the packet") {
    bench.write(grstctl, 2u << 6 | 1u << 5);
    CHECK_FALSE(bench.core.finish_in(2));
    CHECK(bench.log.has("flushed while the core may be using it"));
  }
}

TEST_CASE("reset, flush and disable of an idle endpoint take their time, and stores that concern them are seen") {
  CoreBench bench;
  bench.activate();
  constexpr std::uint32_t csrst = 1, rxfflsh = 1u << 4, txfflsh = 1u << 5, ahbidl = 1u << 31;
  SUBCASE("flush of a transmit FIFO") {
    bench.write(grstctl, 2u << 6 | txfflsh);
    CHECK((bench.read(grstctl) & txfflsh) != 0);
    bench.wait_us(0.1);
    CHECK((bench.read(grstctl) & txfflsh) != 0);
    SUBCASE("waited for") {
      bench.wait_us(0.1);
      CHECK((bench.read(grstctl) & txfflsh) == 0);
      bench.write(grstctl, txfflsh);
      CHECK(bench.log.sentences.empty());
    }
    SUBCASE("another flush") {
      bench.write(grstctl, txfflsh);
      CHECK(bench.log.has("busy with"));
    }
    SUBCASE("the endpoint of the FIFO") {
      bench.write(0x950, 1u << 19);
      CHECK(bench.log.sentences.empty());
      bench.write(0x940, bench.read(0x940) | epena | cnak);
      CHECK(bench.log.has("busy with"));
    }
  }
  SUBCASE("flush of a FIFO whose endpoint may send") {
    bench.write(0x950, 1u << 19 | 4);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    bench.write(grstctl, 2u << 6 | txfflsh);
    CHECK(bench.log.has("flushed while the core may be using it"));
  }
  SUBCASE("flush of the receive FIFO while no packet can come") {
    bench.core.begin_reset();
    bench.write(gintsts, 1u << 12);
    bench.write(grstctl, rxfflsh);
    bench.wait_us(0.2);
    CHECK(bench.log.sentences.empty());
    bench.core.end_reset();
    bench.write(grstctl, rxfflsh);
    CHECK(bench.log.has("flushed while the core may be using it"));
  }
  SUBCASE("flush of the receive FIFO needs the global OUT NAK") {
    bench.write(grstctl, rxfflsh);
    CHECK(bench.log.has("flushed while the core may be using it"));
  }
  SUBCASE("flush of the receive FIFO") {
    bench.write(dctl, 1u << 9);
    bench.read(grxstsp);
    bench.write(grstctl, rxfflsh);
    CHECK((bench.read(grstctl) & rxfflsh) != 0);
    bench.wait_us(0.2);
    CHECK((bench.read(grstctl) & rxfflsh) == 0);
    CHECK(bench.log.sentences.empty());
  }
  SUBCASE("disable") {
    bench.write(0x950, 1u << 19 | 4);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    bench.write(0x940, bench.read(0x940) | epdis | snak);
    CHECK((bench.read(0x948) & 1u << 1) == 0);
    CHECK((bench.read(0x940) & epena) != 0);
    SUBCASE("waited for") {
      bench.wait_us(0.2);
      CHECK((bench.read(0x948) & 1u << 1) != 0);
      CHECK((bench.read(0x940) & epena) == 0);
      bench.write(grstctl, 2u << 6 | txfflsh);
      CHECK(bench.log.sentences.empty());
    }
    SUBCASE("flush meanwhile") {
      bench.write(grstctl, 2u << 6 | txfflsh);
      CHECK(bench.log.has("busy with"));
    }
    SUBCASE("its size meanwhile") {
      bench.write(0x950, 1u << 19);
      CHECK(bench.log.has("busy with"));
    }
  }
  SUBCASE("core reset") {
    bench.write(grstctl, csrst);
    CHECK((bench.read(grstctl) & (csrst | ahbidl)) == csrst);
    SUBCASE("a store meanwhile is lost") {
      bench.write(gahbcfg, 1);
      CHECK(bench.log.has("busy with"));
      bench.wait_us(2);
      CHECK(bench.read(gahbcfg) == 0);
    }
    SUBCASE("waited for, but not for the transceiver's clocks") {
      bench.wait_us(1.01);
      CHECK((bench.read(grstctl) & (csrst | ahbidl)) == ahbidl);
      bench.write(gahbcfg, 1);
      CHECK(bench.log.has("busy with"));
      CHECK(bench.read(gahbcfg) == 1);
    }
    SUBCASE("waited for") {
      bench.wait_us(1.1);
      bench.write(gahbcfg, 1);
      CHECK(bench.log.sentences.empty());
    }
  }
}

TEST_CASE("a bus reset deactivates the endpoints, but leaves them enabled with the content of their FIFOs") {
  CoreBench bench;
  bench.activate();
  bench.write(0x950, 1u << 19 | 4);
  bench.write(0x940, bench.read(0x940) | epena | cnak);
  bench.write(0x3000, 1);
  bench.write(0xB70, 1u << 19 | 64);
  bench.write(0xB60, bench.read(0xB60) | epena | cnak | stall);
  bench.write(0xB60, bench.read(0xB60) & ~stall);
  CHECK(bench.out(3, false, 8) == Handshake::ack);
  bench.write(0xB60, bench.read(0xB60) | stall);
  const std::uint32_t usbaep = 1u << 15;
  bench.core.begin_reset();
  bench.core.end_reset();
  CHECK((bench.read(0x940) & (epena | usbaep | naksts)) == epena);
  CHECK((bench.read(0xB60) & (epena | usbaep | stall)) == (epena | stall));
  CHECK(bench.read(0x958) == 127);
  CHECK((bench.read(grxstsp) >> 17 & 15) == 2);
  bench.read(0x1000);
  bench.read(0x1000);
  CHECK((bench.read(0xB60) & epena) != 0);
  CHECK((bench.read(grxstsp) >> 17 & 15) == 3);
  CHECK((bench.read(0xB60) & epena) == 0);
  CHECK(bench.in(2).handshake == Handshake::nothing);  // not active
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("OUT: the receive FIFO keeps room for SETUP packets and answers NAK when full") {
  CoreBench bench;
  bench.activate();
  bench.write(0xB70, 8u << 19 | 512);
  bench.write(0xB60, bench.read(0xB60) | epena | cnak);
  CHECK(bench.out(3, false, 64) == Handshake::ack);
  CHECK(bench.out(3, true, 64) == Handshake::ack);
  CHECK(bench.out(3, false, 64) == Handshake::nak);  // 56 words: room for only 2 packets of 17 words
  for (int i = 0; i < 3; ++i) CHECK(bench.core.setup(0, 0, some_request) == Handshake::ack);
  CHECK((bench.read(grxstsp) >> 17 & 15) == 2);
  for (int i = 0; i < 16; ++i) bench.read(0x1000);
  bench.read(grxstsp);
  for (int i = 0; i < 16; ++i) bench.read(0x1000);
  CHECK(bench.out(3, true, 64) == Handshake::ack);  // a repetition: acknowledged, not stored
  CHECK((bench.read(0xB70) >> 19 & 0x3FF) == 6);
  CHECK(bench.out(3, false, 10) == Handshake::ack);  // a short packet completes the transfer
  CHECK(bench.out(3, true, 64) == Handshake::nak);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("OUT: CNAK alone starts a transfer, and on endpoint 0 a status stage without a packet count") {
  CoreBench bench;
  bench.activate();
  bench.write(0xB60, bench.read(0xB60) | cnak);
  CHECK(bench.out(3, false, 64) == Handshake::nak);  // there is no transfer yet
  bench.write(0xB70, 1u << 19 | 64);
  bench.write(0xB60, (bench.read(0xB60) | cnak) & ~epena);
  CHECK(bench.out(3, false, 64) == Handshake::ack);
  CHECK(bench.out(3, true, 64) == Handshake::nak);
  bench.read(grxstsp);
  for (int i = 0; i < 16; ++i) bench.read(0x1000);
  bench.read(grxstsp);
  CHECK((bench.read(0xB68) & 1u) != 0);

  bench.write(0xB10, 3u << 29);
  bench.core.setup(0, 0, some_request);
  CHECK(bench.out(0, true, 0) == Handshake::nak);
  bench.read(grxstsp);
  bench.read(0x1000);
  bench.read(0x1000);
  bench.read(grxstsp);
  bench.write(0xB00, cnak);
  CHECK(bench.out(0, true, 0) == Handshake::ack);
  bench.read(grxstsp);
  bench.read(grxstsp);
  CHECK((bench.read(0xB08) & 1u) != 0);
  CHECK((bench.read(0xB10) >> 19 & 1) == 0);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("global NAKs") {
  CoreBench bench;
  bench.activate();
  bench.write(0xB70, 1u << 19 | 64);
  bench.write(0xB60, bench.read(0xB60) | epena | cnak);
  bench.write(dctl, 1u << 9);
  CHECK(bench.out(3, false, 64) == Handshake::nak);
  CHECK((bench.read(gintsts) & gonakeff) == 0);
  CHECK((bench.read(grxstsp) >> 17 & 15) == 1);
  CHECK((bench.read(gintsts) & gonakeff) != 0);
  bench.write(0xB60, bench.read(0xB60) | epdis | snak);
  CHECK((bench.read(0xB68) & 1u << 1) == 0);
  bench.wait_us(0.2);
  CHECK((bench.read(0xB68) & 1u << 1) != 0);
  CHECK((bench.read(0xB60) & epena) == 0);
  bench.write(dctl, 1u << 10);
  CHECK((bench.read(gintsts) & gonakeff) == 0);
  bench.write(dctl, 1u << 7);
  CHECK((bench.read(gintsts) & ginakeff) != 0);
  bench.write(dctl, 1u << 8);
  CHECK((bench.read(gintsts) & ginakeff) == 0);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("TXFE follows the level that GAHBCFG chooses") {
  CoreBench bench;
  bench.activate();
  bench.write(0x950, 8u << 19 | 512);
  bench.write(0x940, bench.read(0x940) | epena | cnak);
  const auto empty = [&] { return (bench.read(0x948) & 1u << 7) != 0; };
  for (int i = 0; i < 64; ++i) bench.write(0x3000, 0);
  CHECK(empty());
  for (int i = 0; i < 16; ++i) bench.write(0x3000, 0);
  CHECK_FALSE(empty());
  bench.write(gahbcfg, 1u << 7 | 1);
  bench.in(2);
  bench.core.finish_in(2);
  CHECK_FALSE(empty());
  for (int i = 0; i < 4; ++i) {
    bench.in(2);
    bench.core.finish_in(2);
  }
  CHECK(empty());
}

TEST_CASE("each access that the manual forbids is reported and has its consequence") {
  CoreBench bench;
  bench.activate();
  SUBCASE("another access within a packet's FIFO writes") {
    bench.write(0x950, 1u << 19 | 8);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    bench.write(0x3000, 1);
    bench.read(gintsts);
    bench.write(0x3000, 2);
    CHECK(bench.log.has("interleaved"));
    CHECK(bench.in(2).handshake == Handshake::nothing);  // a bad CRC
  }
  SUBCASE("more words than are free") {
    bench.write(0x950, 16u << 19 | 1024);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    for (int i = 0; i < 129; ++i) bench.write(0x3000, 0);
    CHECK(bench.log.has("full transmit FIFO"));
  }
  SUBCASE("no packet count") {
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    CHECK(bench.log.has("packet count of 0"));
    CHECK(bench.in(2).handshake == Handshake::nak);
  }
  SUBCASE("an OUT endpoint disabled without the global NAK") {
    bench.write(0xB70, 1u << 19 | 64);
    bench.write(0xB60, bench.read(0xB60) | epena | cnak);
    bench.write(0xB60, bench.read(0xB60) | epdis | snak);
    CHECK(bench.log.has("global OUT NAK"));
    CHECK((bench.read(0xB68) & 1u << 1) == 0);
  }
  SUBCASE("the size of an OUT transfer that is under way") {
    bench.write(0xB70, 1u << 19 | 64);
    bench.write(0xB60, bench.read(0xB60) | epena | cnak);
    bench.write(0xB70, 1u << 19 | 64);
    CHECK(bench.log.has("while its OUT endpoint is enabled"));
  }
  SUBCASE("data left in the receive FIFO") {
    bench.core.setup(0, 0, std::array<std::byte, 8>{std::byte{0x80}, std::byte{6}});
    bench.read(grxstsp);
    CHECK(bench.read(grxstsp) == 0x0680);
    CHECK(bench.log.has("read as a status word"));
  }
  SUBCASE("FIFOs that overlap") {
    bench.write(0x108, 128u << 16 | 80);
    bench.write(0x104, 16u << 16 | 72);
    bench.write(0x920, 1u << 22 | 3u << 18 | 1u << 15 | 64);
    bench.write(0x950, 1u << 19);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    CHECK(bench.log.has("overlap"));
  }
  SUBCASE("the firmware enables an endpoint before it configures the FIFO of the endpoint") {
    bench.write(0x950, 1u << 19);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    CHECK(bench.log.sentences.empty());
    bench.write(0x960, 1u << 28 | 3u << 22 | 2u << 18 | 1u << 15 | 64);
    bench.write(0x970, 1u << 19);
    bench.write(0x960, bench.read(0x960) | epena | cnak);
    CHECK(bench.log.has("beyond the 320 words"));
  }
  SUBCASE("a data endpoint has the type control") {
    bench.write(0x940, 1u << 28 | 2u << 22 | 1u << 15 | 64);
    bench.write(0x950, 1u << 19);
    bench.write(0x940, bench.read(0x940) | epena | cnak);
    CHECK(bench.log.has("whose EPTYP is control"));
  }
  SUBCASE("the turnaround time is too short at the first packet") {
    bench.write(0x00C, (bench.read(0x00C) & ~(0xFu << 10)) | 1u << 10);
    bench.core.begin_reset();
    bench.core.end_reset();
    CHECK(bench.log.sentences.empty());
    bench.core.setup(0, 0, some_request);
    CHECK(bench.log.has("TRDT"));
  }
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
