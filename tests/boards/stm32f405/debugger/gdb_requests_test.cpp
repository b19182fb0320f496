#include <doctest/doctest.h>

#include <cstdio>
#include <string>

#include "boards/stm32f405/debugger/gdb_requests.hpp"

using namespace inkwell::virtual_board::gdb;

namespace {

/// Returns the answer to the packet, or a placeholder if the answer depends on the chip.
std::string answer_to(std::string_view packet) {
  const Request request = request_of(packet);
  const auto* const answered = std::get_if<Answered>(&request);
  return answered != nullptr ? answered->reply : "(asks the chip)";
}

template <class Asked>
Asked asked_by(std::string_view packet) {
  const Request request = request_of(packet);
  REQUIRE(std::holds_alternative<Asked>(request));
  return std::get<Asked>(request);
}

}  // namespace

TEST_SUITE("virtual board: debugger") {
  TEST_CASE("a malformed packet is answered with an error and never reaches the chip") {
    for (const char* packet : {"p22",
                               "pg",
                               "p",
                               "P0",
                               "P0=",
                               "P0=0000",
                               "P22=00000000",
                               "G",
                               "G00",
                               "m",
                               "m20000000",
                               "m20000000,2001",
                               "m,4",
                               "M20000000,4",
                               "M20000000,4:00",
                               "M20000000,1:0",
                               "X20000000,2:a",
                               "Z0",
                               "Z0,20000000",
                               "z2,,4",
                               "qXfer:features:read:target.xml:0",
                               "qRcmd,7"}) {
      CAPTURE(packet);
      CHECK(answer_to(packet) == "E01");
    }
  }

  TEST_CASE("an unknown packet gets an empty answer, so that GDB uses a different packet") {
    for (const char* packet : {"", "!", "Z5,20000000,4", "c20000000", "s20000000", "vMustReplyEmpty", "vCont;",
                               "vCont;t", "qXfer:memory-map:read::0,40", "QNonStop:1"}) {
      CAPTURE(packet);
      CHECK(answer_to(packet).empty());
    }
  }

  TEST_CASE("a valid request is parsed, up to the largest register numbers and lengths") {
    CHECK(asked_by<ReadRegister>("p21").number == 33);
    const auto set = asked_by<WriteRegister>("P11=0123456789abcdef");
    CHECK(set.number == first_double);
    CHECK(set.bytes == std::vector<std::uint8_t>{0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF});
    CHECK(asked_by<WriteRegisters>("G" + std::string(2 * (17 * 4 + 16 * 8 + 4), '7')).bytes.size() ==
          size_of_all_registers);
    CHECK(std::holds_alternative<StopAcknowledging>(request_of("QStartNoAckMode")));
    CHECK(asked_by<WriteMemory>("M2001e000,2:2a01").bytes == std::vector<std::uint8_t>{0x2A, 1});
    CHECK(asked_by<ReadMemory>("m20000000,2000").range == Range{0x2000'0000, 0x2000});
    const auto written = asked_by<WriteMemory>("X2000e000,2:#\x01");
    CHECK(written.address == 0x2000'E000);
    CHECK(written.bytes == std::vector<std::uint8_t>{'#', 1});
    CHECK(answer_to("X20000000,0:") == "OK");
    const auto watched = asked_by<ChangeWatchPoint>("Z3,2001f000,4;cond");
    CHECK(watched.sets);
    CHECK(watched.kind == '3');
    CHECK(watched.range == Range{0x2001'F000, 4});
    CHECK(asked_by<ChangeWatchPoint>("Z2,2001f000,4").kind == '2');
    CHECK(asked_by<ChangeWatchPoint>("Z4,2001f000,4").kind == '4');
    CHECK_FALSE(asked_by<ChangeBreakpoint>("z1,8000000,2").sets);
    CHECK(asked_by<Resume>("vCont;s:1").steps);
    CHECK_FALSE(asked_by<Resume>("C0b").steps);
    CHECK(asked_by<Resume>("S05").steps);
    CHECK_FALSE(asked_by<Resume>("vCont;C05:1").steps);
    CHECK(asked_by<Resume>("vCont;S05:1").steps);
    CHECK(asked_by<LetGo>("D;1").wants_answer);
    CHECK_FALSE(asked_by<LetGo>("k").wants_answer);
    CHECK(asked_by<Monitor>("qRcmd,7265736574").command == "reset");
  }

  TEST_CASE("the target description is sent in parts, and the last part is marked") {
    std::string whole;
    for (unsigned offset = 0;; offset += 0x100) {
      char packet[64];
      std::snprintf(packet, sizeof packet, "qXfer:features:read:target.xml:%x,100", offset);
      const std::string part = answer_to(packet);
      whole += part.substr(1);
      if (part[0] == 'l') break;
      REQUIRE(part.size() == 0x101);
    }
    CHECK(whole.starts_with("<?xml"));
    CHECK(whole.ends_with("</target>"));
    CHECK(answer_to("qXfer:features:read:target.xml:ffffff,100") == "l");
  }
}
