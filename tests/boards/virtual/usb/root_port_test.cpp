// Tests transfers over the modeled bus between a host and a correct driver.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "boards/stm32f405/otg_fs/bit_stuffing.hpp"
#include "tests/boards/virtual/usb/root_port_bench.hpp"

namespace inkwell::virtual_usb_test {
namespace {

namespace status = virtual_board::transfer_status;

Bytes patterned(std::size_t length) {
  Bytes bytes(length);
  for (std::size_t i = 0; i < length; ++i) bytes[i] = pattern(i);
  return bytes;
}

TEST_CASE("the host enumerates the device and then lets the bus fall silent") {
  RootPortBench bench;
  bench.enumerate();
  CHECK(bench.interrupts.position() == 67);
  CHECK(bench.description.vendor() == 0x1209);
  CHECK(bench.description.product() == 0x0001);
  CHECK(bench.description.release() == 0x0134);
  REQUIRE(bench.description.configurations.size() == 1);
  CHECK(bench.description.configurations[0].value == 5);
  CHECK(bench.description.configurations[0].interfaces.size() == 2);
  CHECK(bench.description.configurations[0].endpoints.size() == 4);
  CHECK(bench.firmware.resets == 2);
  CHECK(bench.firmware.address == 2);
  CHECK(bench.firmware.suspends >= 1);
  const unsigned frames = bench.firmware.frames;
  bench.run_for(0.1);
  CHECK(bench.firmware.frames == frames);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("nothing is enumerated without the cable, or with a device that does not answer") {
  RootPortBench bench;
  bench.firmware.start();
  bench.run_for(0.5);
  CHECK(bench.firmware.resets == 0);
  bench.firmware.answers_requests = false;
  bench.port.plug(true);
  bench.run_for(1.5);
  CHECK_FALSE(bench.port.enumerated());
  CHECK(bench.firmware.resets >= 2);
  bench.firmware.answers_requests = true;
  bench.run_for(1.5);
  CHECK(bench.port.enumerated());
}

TEST_CASE("a host that hangs requests no data, its frames continue, and its transfers continue afterwards") {
  RootPortBench bench;
  bench.use();
  bench.port.set_host_polling(false);
  const unsigned frames = bench.firmware.frames;
  const std::uint32_t request = bench.submit_control(0x80, 6, 0x0100, 18);
  bench.run_for(0.1);
  CHECK_FALSE(bench.outcomes.contains(request));
  CHECK(bench.firmware.frames - frames >= 99);
  bench.port.set_host_polling(true);
  CHECK(bench.wait_for(request).status == 0);
}

TEST_CASE("an import resets, addresses and runs frames of one millisecond") {
  RootPortBench bench;
  bench.enumerate();
  bench.port.import();
  const std::uint32_t held = bench.submit_control(0x80, 6, 0x0100, 18);
  CHECK(bench.wait_for(held).data.size() == 18);
  CHECK(bench.firmware.resets == 3);
  const unsigned frames = bench.firmware.frames;
  bench.run_for(0.25);
  CHECK(bench.firmware.frames - frames == 250);
  bench.port.release();
  const unsigned suspends = bench.firmware.suspends;
  bench.run_for(0.0025);
  CHECK(bench.firmware.suspends == suspends);
  bench.run_for(0.002);
  CHECK(bench.firmware.suspends == suspends + 1);
}

TEST_CASE("frames come by the host's own clock") {
  for (const int clock_ppm : {500, -500}) {
    CAPTURE(clock_ppm);
    RootPortBench bench(clock_ppm);
    bench.use();
    const unsigned frames = bench.firmware.frames;
    bench.run_for(4.0);
    CHECK(static_cast<int>(bench.firmware.frames - frames) == 4000 + 4 * clock_ppm / 1000);
  }
}

TEST_CASE("control transfers of every awkward length") {
  RootPortBench bench;
  bench.use();
  for (const unsigned length : {0u, 1u, 8u, 63u, 64u, 65u, 127u, 128u, 129u, 1000u, 4096u}) {
    CAPTURE(length);
    const Outcome exact = bench.control(0xC0, 1, length, length);
    CHECK(exact.status == 0);
    CHECK(exact.data == patterned(length));
    const Outcome shorter = bench.control(0xC0, 1, length, length + 64);  // needs a zero-length packet at multiples of
                                                                          // 64
    CHECK(shorter.status == 0);
    CHECK(shorter.data == patterned(length));
    const Outcome sent = bench.control(0x40, 2, 0, length, patterned(length));
    CHECK(sent.status == 0);
    CHECK(sent.actual == length);
    CHECK(bench.firmware.control_received == patterned(length));
  }
  CHECK(bench.firmware.setup_done == bench.firmware.setups);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("an unknown request stalls and the next one works") {
  RootPortBench bench;
  bench.use();
  for (int i = 0; i < 3; ++i) {
    CHECK(bench.control(0xC0, 99, 0, 8).status == status::stalled);
    CHECK(bench.control(0x40, 99, 0, 0).status == status::stalled);
    CHECK(bench.control(0xC0, 1, 20, 20).data == patterned(20));
  }
}

TEST_CASE("bulk IN fills the frame: 19 packets of 64 bytes, in order") {
  RootPortBench bench;
  bench.firmware.stream(true);
  bench.use();
  constexpr std::uint32_t length = 4096;
  std::vector<std::uint32_t> urbs;
  for (int i = 0; i < 64; ++i) urbs.push_back(bench.submit_in(2, length));
  bench.run_for(0.1);
  std::size_t received = 0;
  std::uint32_t expected = 0;
  for (const std::uint32_t urb : urbs) {
    if (!bench.outcomes.contains(urb)) break;
    const Bytes& data = bench.outcomes.at(urb).data;
    REQUIRE(data.size() == length);
    for (std::size_t i = 0; i < data.size(); i += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, data.data() + i, 4);
      REQUIRE(word == expected++);
    }
    received += data.size();
  }
  CHECK(received <= 19u * 64 * 100);
  CHECK(received >= 18u * 64 * 100);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("a zero is stuffed after six ones of a data packet") {
  using virtual_board::stuffed_bits;
  CHECK(stuffed_bits(false, {}) == 0);
  CHECK(stuffed_bits(false, Bytes(64)) == 1);  // in the checksum
  // The last two bits of the packet identifier continue the sequence of 1 bits.
  CHECK(stuffed_bits(false, Bytes(64, std::byte{0xFF})) == 512 / 6 + 1);
  CHECK(stuffed_bits(false, Bytes{std::byte{0xF8}, std::byte{0x01}}) == 1);
  CHECK(stuffed_bits(false, Bytes{std::byte{0xF0}, std::byte{0x01}}) == 0);
}

TEST_CASE("bits that are stuffed take bus time") {
  RootPortBench bench;
  bench.use();
  const auto duration = [&](std::byte content) {
    const std::uint32_t first = bench.submit_out(3, Bytes(64, content));
    const std::uint32_t last = bench.submit_out(3, Bytes(64 * 12, content));
    return bench.wait_for(last).when - bench.wait_for(first).when;
  };
  const Ticks zeros = duration(std::byte{0}), ones = duration(std::byte{0xFF});
  constexpr double bit_s = 1.0 / 12e6;
  const double added_bits = (virtual_board::seconds(ones) - virtual_board::seconds(zeros)) / bit_s;
  CHECK(added_bits == doctest::Approx(12 * (86 - 1)).epsilon(0.001));
}

TEST_CASE("an interrupt OUT transfer is sent in the frame after its submission, independent of the previous transfer") {
  RootPortBench bench;
  bench.use();
  for (int i = 0; i < 3; ++i) {
    const unsigned before = bench.firmware.frames;
    while (bench.firmware.frames == before) bench.run_for(0.0001);
    const auto report = bench.submit_out(1, Bytes(8));
    while (!bench.outcomes.contains(report)) bench.run_for(0.0001);
    CHECK(bench.firmware.frames == before + 2);
    if (i == 1) bench.run_for(0.005);
  }
}

TEST_CASE("interrupt IN transfers complete every millisecond next to a full bulk stream") {
  RootPortBench bench;
  bench.firmware.stream(true);
  bench.firmware.report_every_millisecond = true;
  bench.use();
  std::vector<std::uint32_t> reports;
  for (int i = 0; i < 200; ++i) reports.push_back(bench.submit_in(1, 64));
  for (int i = 0; i < 100; ++i) bench.submit_in(2, 4096);
  bench.run_for(0.202);  // the frame in progress, and one more for the first report
  for (std::uint32_t i = 0; i < reports.size(); ++i) {
    REQUIRE(bench.outcomes.contains(reports[i]));
    std::uint32_t number = 0;
    std::memcpy(&number, bench.outcomes.at(reports[i]).data.data(), 4);
    CHECK(number == i);
    if (i == 0) continue;
    const Ticks gap = bench.outcomes.at(reports[i]).when - bench.outcomes.at(reports[i - 1]).when;
    CHECK(virtual_board::seconds(gap) == doctest::Approx(1e-3).scale(0).epsilon(1e-4));
  }
  std::size_t bulk = 0;
  for (const auto& [which, outcome] : bench.outcomes)
    if (outcome.data.size() == 4096) bulk += outcome.data.size();
  CHECK(bulk <= 18u * 64 * 202);
  CHECK(bulk >= 17u * 64 * 202);
}

TEST_CASE("bInterval is honoured") {
  RootPortBench bench;
  bench.firmware.report_interval = 8;
  bench.firmware.report_every_millisecond = true;
  bench.use();
  for (int i = 0; i < 100; ++i) bench.submit_in(1, 64);
  const std::size_t before = bench.outcomes.size();
  bench.run_for(0.16);
  CHECK(bench.outcomes.size() - before == 20);
}

TEST_CASE("NAK keeps a transfer pending until the device has something") {
  RootPortBench bench;
  bench.use();
  const std::uint32_t urb = bench.submit_in(1, 64);
  bench.run_for(0.3);
  CHECK_FALSE(bench.outcomes.contains(urb));
  bench.firmware.send_report(patterned(10));
  CHECK(bench.wait_for(urb, 0.003).data == patterned(10));
  CHECK(bench.outcomes.at(urb).status == 0);
  const std::uint32_t strict = bench.submit_in(1, 64, virtual_board::transfer_flag::short_is_error);
  bench.firmware.send_report(patterned(10));
  CHECK(bench.wait_for(strict).status == status::short_packet);
}

TEST_CASE("OUT transfers: reports, long bulk, a device that does not listen for a while") {
  RootPortBench bench;
  bench.use();
  CHECK(bench.wait_for(bench.submit_out(1, patterned(33))).actual == 33);
  CHECK(bench.firmware.report_received == patterned(33));
  CHECK(bench.wait_for(bench.submit_out(3, patterned(1000))).status == 0);
  CHECK(bench.firmware.bulk_received == patterned(1000));

  bench.firmware.bulk_received.clear();
  bench.firmware.take_bulk(false);
  CHECK(bench.wait_for(bench.submit_out(3, patterned(64))).status == 0);  // the packet that was already armed
  const std::uint32_t urb = bench.submit_out(3, patterned(128), virtual_board::transfer_flag::zero_packet);
  bench.run_for(0.1);
  CHECK_FALSE(bench.outcomes.contains(urb));
  bench.firmware.take_bulk(true);
  CHECK(bench.wait_for(urb).actual == 128);
  CHECK(bench.firmware.bulk_received.size() == 64 + 128);
  CHECK(bench.log.sentences.empty());
}

TEST_CASE("a halted endpoint returns -EPIPE until the host clears the halt, and then its data toggle restarts") {
  RootPortBench bench;
  bench.firmware.stream(true);
  bench.use();
  CHECK(bench.wait_for(bench.submit_in(2, 64 * 3)).status == 0);  // an odd number of packets: the toggle is DATA1
  bench.firmware.halt_bulk_in();
  CHECK(bench.wait_for(bench.submit_in(2, 640)).status == status::stalled);
  CHECK(bench.wait_for(bench.submit_in(2, 640)).status == status::stalled);
  CHECK(bench.control(0x02, 1, 0, 0, {}, 0x82).status == 0);
  const Outcome after = bench.wait_for(bench.submit_in(2, 640));
  CHECK(after.status == 0);
  std::uint32_t word = 0;
  std::memcpy(&word, after.data.data(), 4);
  CHECK(word == 3 * 16);  // no word lost or repeated
}

TEST_CASE("a packet larger than the room left is an overflow") {
  RootPortBench bench;
  bench.use();
  const std::uint32_t urb = bench.submit_in(1, 20);
  bench.firmware.send_report(patterned(40));
  CHECK(bench.wait_for(urb).status == status::overflow);
  CHECK(bench.outcomes.at(urb).data == patterned(20));
}

TEST_CASE("endpoints exist only after the configuration") {
  RootPortBench bench;
  bench.use(false);
  bench.run_for(0.1);
  CHECK(bench.wait_for(bench.submit_in(2, 64)).status == status::invalid);
  CHECK(bench.control(0x00, 9, 5, 0).status == 0);
  const std::uint32_t pending = bench.submit_in(2, 64);
  bench.run_for(0.01);
  CHECK_FALSE(bench.outcomes.contains(pending));
  CHECK(bench.control(0x00, 9, 0, 0).status == 0);
  CHECK(bench.wait_for(pending).status == status::invalid);
}

TEST_CASE("unlinked transfers are never answered, the others are") {
  RootPortBench bench;
  bench.use();
  const std::uint32_t first = bench.submit_in(1, 64);
  const std::uint32_t second = bench.submit_in(1, 64);
  bench.run_for(0.01);
  CHECK(bench.port.unlink(first));
  CHECK_FALSE(bench.port.unlink(first));
  bench.firmware.send_report(patterned(5));
  CHECK(bench.wait_for(second).data == patterned(5));
  CHECK_FALSE(bench.outcomes.contains(first));
  CHECK_FALSE(bench.port.unlink(second));
}

TEST_CASE("unplug in the middle of everything, then plug in again") {
  for (const double moment_s : {0.05, 0.105, 0.125, 0.15, 0.2, 0.5003, 0.5211, 0.5407, 0.6001}) {
    CAPTURE(moment_s);
    RootPortBench bench;
    bench.firmware.stream(true);
    bench.firmware.start();
    bench.port.plug(true);
    bench.run_for(std::min(moment_s, 0.5));
    if (bench.port.enumerated()) {
      bench.port.import();
      bench.submit_control(0x00, 9, 5, 0);
      bench.submit_control(0xC0, 1, 4096, 4096);
      bench.run_for(std::max(0.0, moment_s - 0.5));
      for (int i = 0; i < 10; ++i) bench.submit_in(2, 4096);
      bench.run_for(0.0003);
    }
    bench.port.plug(false);
    CHECK_FALSE(bench.port.enumerated());
    const std::size_t answered = bench.outcomes.size();
    bench.run_for(0.1);
    CHECK(bench.outcomes.size() == answered);
    bench.port.plug(true);
    bench.run_for(0.5);
    REQUIRE(bench.port.enumerated());
    bench.port.import();
    CHECK(bench.control(0x00, 9, 5, 0).status == 0);
    CHECK(bench.wait_for(bench.submit_in(2, 4096)).data.size() == 4096);
  }
}

TEST_CASE("a soft disconnect is noticed even if it is over within a frame") {
  RootPortBench bench;
  bench.use();
  constexpr std::uint32_t dctl = 0x804;
  bench.firmware.set(dctl, 2);
  bench.firmware.write(dctl, bench.firmware.read(dctl) & ~2u);
  bench.run_for(0.002);
  CHECK(bench.detachments == 1);
  bench.run_for(0.5);
  CHECK(bench.port.enumerated());
}

TEST_CASE("a reset of the chip takes the device off the bus") {
  RootPortBench bench;
  bench.use();
  bench.core.reset();
  bench.run_for(0.01);
  CHECK(bench.detachments == 1);
  CHECK_FALSE(bench.port.enumerated());
  bench.firmware.start();
  bench.run_for(0.5);
  CHECK(bench.port.enumerated());
}

TEST_CASE("CNAK before the setup-done word is popped loses that word, as on silicon") {
  RootPortBench bench;
  bench.use();
  bench.firmware.clears_nak_too_early = true;
  const unsigned done = bench.firmware.setup_done;
  const std::uint32_t urb = bench.submit_control(0xC0, 1, 8, 8);
  bench.run_for(0.1);
  CHECK_FALSE(bench.outcomes.contains(urb));
  CHECK(bench.firmware.setup_done == done);
  CHECK(bench.log.has("CNAK"));
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
