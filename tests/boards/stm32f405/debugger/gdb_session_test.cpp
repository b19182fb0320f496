#include <doctest/doctest.h>

#include "boards/stm32f405/debugger/gdb_session.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

namespace {

struct Debugger {
  explicit Debugger(const std::string& firmware) : test(firmware), session(test.chip) {
    session.attach();
    CHECK(session.receive(gdb_packet("QStartNoAckMode")) == "+" + gdb_packet("OK"));
  }
  /// Returns the payload of the answer, or an empty string.
  std::string ask(const std::string& packet) { return payload(session.receive(gdb_packet(packet))); }
  static std::string payload(const std::string& wire) {
    GdbPackets packets;
    packets.feed(wire);
    std::string last;
    while (const auto received = packets.take()) last = received->payload;
    return last;
  }
  /// Runs like the simulation. Returns the payload of the stop reply, or an empty string after `time_s`.
  std::string run(double time_s = 0.01) {
    return payload(session.report(test.chip.run_until(test.chip.now() + ticks(time_s))));
  }
  std::uint32_t pc() { return test.chip.debug_port().core_registers().general[CoreRegisters::pc]; }

  ChipUnderTest test;
  GdbSession session;
};

std::string digits(std::uint32_t value) {
  return hexadecimal(std::span(reinterpret_cast<const std::uint8_t*>(&value), 4));
}

/// Returns the address of the first instruction of read_too_far, which reads an unmapped address.
std::uint32_t address_of_cpu_fault() {
  ChipUnderTest test("lock_up");
  test.run_for(0.01);
  return test.chip.first_fault().value().registers.general[CoreRegisters::pc];
}

}  // namespace

TEST_SUITE("virtual board: debugger") {
  TEST_CASE("a breakpoint stops before its instruction, a step stops after it, and GDB can step into a fault handler") {
    Debugger gdb("lock_up");
    const std::uint32_t address = address_of_cpu_fault();
    char packet[32];
    std::snprintf(packet, sizeof packet, "Z1,%x,2", static_cast<unsigned>(address));
    CHECK(gdb.ask(packet) == "OK");
    CHECK(gdb.session.halted());
    CHECK(gdb.ask("c").empty());
    CHECK_FALSE(gdb.session.halted());
    CHECK(gdb.run() == "T05thread:1;");
    CHECK(gdb.session.halted());
    CHECK(gdb.pc() == address);
    CHECK(gdb.ask("p0") == digits(0x6000'0000));
    CHECK(gdb.ask("pf") == digits(address));
    CHECK(gdb.ask("vCont;s:1").empty());
    CHECK(gdb.run() == "T05thread:1;");
    CHECK((gdb.test.chip.debug_port().core_registers().xpsr & 0x1FF) == 3);
    // With GDB, a breakpoint in the handler stops the program normally.
    CHECK(gdb.ask("c").empty());
    CHECK(gdb.run() == "T05thread:1;");
    // Without GDB, a breakpoint in the handler is a second fault.
    CHECK(gdb.session.receive(gdb_packet("D")) == gdb_packet("OK"));
    CHECK(gdb.test.chip.run_until(gdb.test.chip.now() + ticks(0.001)) == Stop::locked_up);
  }

  TEST_CASE("GDB can write registers and memory to repair a program before it fails") {
    Debugger gdb("lock_up");
    char packet[32];
    std::snprintf(packet, sizeof packet, "Z0,%x,2", static_cast<unsigned>(address_of_cpu_fault()));
    gdb.ask(packet);
    gdb.ask("c");
    gdb.run();
    packet[0] = 'z';
    CHECK(gdb.ask(packet) == "OK");
    CHECK(gdb.ask("M2001e000,4:2a000000") == "OK");
    CHECK(gdb.ask("m2001e000,4") == "2a000000");
    CHECK(gdb.ask("P0=00e00120") == "OK");
    CHECK(gdb.ask("s").empty());
    gdb.run();
    CHECK(gdb.ask("p0") == "2a000000");
    const std::string all = gdb.ask("g");
    CHECK(all.size() == 2 * (17 * 4 + 16 * 8 + 4));
    CHECK(gdb.ask("G" + all) == "OK");
    CHECK(gdb.ask("g") == all);
    CHECK(gdb.ask("m60000000,4") == "E0e");
    CHECK(gdb.ask("M08000000,4:00000000") == "E0e");
    CHECK(gdb.ask("me000ed00,4") == "41c20f41");  // CPUID, a register
    CHECK(gdb.test.log.empty());
  }

  TEST_CASE("a write watch point stops after the instruction that writes to its address") {
    Debugger gdb("lock_up");
    CHECK(gdb.ask("Z2,2001f000,4") == "OK");  // results[0]
    gdb.ask("c");
    CHECK(gdb.run() == "T05thread:1;watch:2001f000;");
    CHECK(gdb.test.result(0) == finished);
    CHECK(gdb.ask("z2,2001f000,4") == "OK");
    gdb.ask("c");
    CHECK(gdb.run() == "T05thread:1;");  // the handler's breakpoint
  }

  TEST_CASE("a step does not enter an interrupt handler, and the interrupts run after the step") {
    Debugger gdb("exceptions");
    gdb.ask("c");
    while (gdb.test.chip.counters().exceptions[15].count < 3) CHECK(gdb.run(1e-6).empty());
    CHECK(Debugger::payload(gdb.session.receive("\x03")) == "T02thread:1;");
    const auto before = gdb.test.chip.counters().exceptions[15].count;
    REQUIRE((gdb.test.chip.debug_port().core_registers().xpsr & 0x1FF) == 0);
    for (int i = 0; i < 20; ++i) {
      gdb.ask("s");
      CHECK(gdb.run(1e-3) == "T05thread:1;");
      REQUIRE((gdb.test.chip.debug_port().core_registers().xpsr & 0x1FF) == 0);
    }
    CHECK(gdb.test.chip.counters().exceptions[15].count == before);
    gdb.ask("c");
    gdb.run(0.001);
    CHECK(gdb.test.chip.counters().exceptions[15].count > before);
  }

  TEST_CASE("a lock-up and a reset") {
    Debugger gdb("no_handler");
    gdb.ask("c");
    const std::string wire = gdb.session.report(gdb.test.chip.run_until(ticks(0.001)));
    CHECK(Debugger::payload(wire) == "T0bthread:1;");
    CHECK(wire.find("$O") == 0);
    CHECK(gdb.ask("qRcmd," + hexadecimal(std::string_view("reset"))) == "OK");
    CHECK(gdb.pc() == (gdb.test.chip.memory_word(0x0800'0004) & ~1u));
    CHECK(gdb.ask("qRcmd," + hexadecimal(std::string_view("dance"))).size() > 20);
  }

  TEST_CASE("GDB reads the target description in parts") {
    Debugger gdb("lock_up");
    CHECK(gdb.ask("qSupported:xmlRegisters=arm").find("qXfer:features:read+") != std::string::npos);
    std::string text;
    for (;;) {
      char packet[64];
      std::snprintf(packet, sizeof packet, "qXfer:features:read:target.xml:%zx,100", text.size());
      const std::string part = gdb.ask(packet);
      REQUIRE_FALSE(part.empty());
      text += part.substr(1);
      if (part[0] == 'l') break;
      REQUIRE(part[0] == 'm');
    }
    CHECK(text.find("org.gnu.gdb.arm.m-profile") != std::string::npos);
    CHECK(text.find("fpscr") != std::string::npos);
    CHECK(text.ends_with("</target>"));
  }

  TEST_CASE("nonsense is refused, and no packet makes it fall over") {
    Debugger gdb("lock_up");
    for (const char* packet : {"m", "m20000000", "mzz,4", "m20000000,fffffff", "M20000000,4:00", "P0", "P99=00000000",
                               "p99", "G00", "Z1", "Z1,zz,2", "qXfer:features:read:target.xml:0", "qRcmd,0"})
      CHECK(gdb.ask(packet) == "E01");
    for (const char* packet : {"", "!", "vRun", "vCont;", "vCont;q", "Z9,0,2", "qUnknown", "c20000000"})
      CHECK(gdb.ask(packet).empty());
    CHECK(gdb.session.halted());
    CHECK(gdb.ask("mfffffffe,10") == "E0e");
    CHECK(gdb.session.receive("$g#00") == "");
  }
}
