// Tests an arm on a USB cable. FakeUsb replaces hidapi (reports) and libusb (scope).
#include <doctest/doctest.h>

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>

#include "host/client/device/device.hpp"
#include "host/client/device/session.hpp"
#include "protocol/black_box.hpp"
#include "protocol/report_table.hpp"
#include "protocol/usb_identity.hpp"
#include "tests/failure.hpp"

#include "host/client/device/usb_rules.hpp"

#include "tests/host/client/device/fake_usb.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;

namespace {

Bytes bulk_number(int number) { return Bytes(100, static_cast<std::byte>(number)); }

}  // namespace

TEST_CASE("find_usb_devices identifies arms by their identifiers and product name") {
  FakeUsb usb;
  usb.add_arm("A");
  usb.add_arm("B").product = L"Somebody's test";
  usb.add_arm("C").vendor_id = 0x1234;
  usb.add_arm("D").product_id = 2;
  const auto found = device::find_usb_devices();
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == device::Endpoint::Kind::usb);
  CHECK(found[0].serial_number == "A");
  CHECK(found[0].product == protocol::usb::product);
  CHECK(found[0].path == "/fake/A");
  CHECK_FALSE(found[0].is_virtual);
  CHECK(usb.open_things == 0);
}

TEST_CASE("a serial number with control characters is shown without them, and still leads to its arm") {
  FakeUsb usb;
  usb.add_arm("A\x1B[2J\n\x7F");
  const auto found = device::find_usb_devices();
  REQUIRE(found.size() == 1);
  CHECK(found[0].serial_number == "A?[2J ?");
  const auto transport = device::open_transport(found[0]);
  CHECK_NOTHROW(transport->claim_scope());
}

TEST_CASE("the scope is read from the arm with this serial number, at the endpoint of its descriptors") {
  FakeUsb usb;
  usb.add_arm("other");
  usb.add_arm("this").vendor_id = 0x1234;
  usb.add_arm("this").product_id = 2;
  usb.add_arm("locked").open_result = LIBUSB_ERROR_ACCESS;  // access is denied, and the serial number differs
  auto& arm = usb.add_arm("this", 0, 0x83);
  {
    const auto transport = device::open_transport(arm.endpoint());
    std::array<std::byte, 200> buffer{};
    CHECK(transport->read_bulk(buffer, 1ms) == 0);
    CHECK(arm.claimed.empty());
    CHECK(usb.endpoints_under_way(arm).empty());

    transport->claim_scope();
    transport->claim_scope();  // a second claim has no effect
    CHECK(arm.claimed == std::set<int>{0});
    CHECK(usb.endpoints_under_way(arm) == std::vector<std::uint8_t>(21, 0x83));
    usb.send_bulk(arm, {});  // an empty transfer
    for (int i = 0; i < 100; ++i) usb.send_bulk(arm, bulk_number(i));
    for (int i = 0; i < 100; ++i) {
      REQUIRE(transport->read_bulk(buffer, 5s) == 100);
      CHECK(std::to_integer<int>(buffer[99]) == i);
    }
    for (const auto& device : usb.devices) CHECK(device.claimed.empty() == (&device != &arm));
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("a scope that another program has claimed costs only the scope") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  arm.taken = {1};
  arm.features[0x10] = Bytes(4, std::byte{0x10});
  {
    const auto transport = device::open_transport(arm.endpoint());
    CHECK(message_of<device::InUse>([&] { transport->claim_scope(); }).find("other program") != std::string::npos);
    Bytes report(4, std::byte{0x10});
    CHECK(transport->get_feature(report) == 4);
    arm.taken.clear();
    transport->claim_scope();
    CHECK(arm.claimed == std::set<int>{1});
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("a scope that was given back is another program's to claim, and may be had again") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  {
    const auto transport = device::open_transport(arm.endpoint());
    std::array<std::byte, 200> buffer{};
    for (int times = 1; times < 3; ++times) {
      transport->claim_scope();
      usb.send_bulk(arm, bulk_number(times));
      REQUIRE(transport->read_bulk(buffer, 5s) == 100);
      CHECK(std::to_integer<int>(buffer[0]) == times);
      transport->release_scope();
      CHECK(arm.claimed.empty());
      CHECK(usb.endpoints_under_way(arm).empty());
      CHECK(transport->read_bulk(buffer, 1ms) == 0);
    }
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE(
    "a session works without the scope while another program uses it, reports this, and requests the scope again") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  answer_as_inkwell(arm);
  {
    const std::lock_guard lock(usb.mutex);
    arm.taken = {1};
  }
  std::atomic<int> searches = 0;
  {
    device::Session session([&] {
      ++searches;
      return std::optional(arm.endpoint());
    });
    session.select_signals({protocol::Signal::force_N});
    REQUIRE(eventually([&] { return session.status().message.find("scope is in use") != std::string::npos; }));
    CHECK(session.status().connection == device::Connection::connected);
    {
      const std::lock_guard lock(usb.mutex);
      arm.taken.clear();
    }
    for (std::uint32_t sequence = 1; usb.endpoints_under_way(arm).empty(); ++sequence) {
      REQUIRE(sequence < 5000);
      protocol::PoseReport pose{.report_id = protocol::ReportId::pose};
      pose.sequence = sequence;
      pose.time_periods = sequence * protocol::servo_rate_Hz / 1000;
      usb.send_report(arm, bytes_of(pose));
      std::this_thread::sleep_for(1ms);
    }
    CHECK(eventually([&] { return session.status().message.find("Connected") != std::string::npos; }));
    CHECK(searches == 1);
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("the error for an arm without access permission contains the udev line") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  arm.open_result = LIBUSB_ERROR_ACCESS;
  {
    const auto transport = device::open_transport(arm.endpoint());
    const auto message = message_of<device::NoPermission>([&] { transport->claim_scope(); });
    CHECK(
        message.ends_with("/etc/udev/rules.d/60-inkwell.rules: SUBSYSTEM==\"usb|hidraw\", "
                          "SUBSYSTEMS==\"usb\", ATTRS{idVendor}==\"1209\", ATTRS{idProduct}==\"0001\", "
                          "TAG+=\"uaccess\""));
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("after an unplug, received data is still read, and then every call raises Disconnected") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  {
    const auto transport = device::open_transport(arm.endpoint());
    transport->claim_scope();
    usb.send_bulk(arm, bulk_number(1));
    REQUIRE(eventually([&] { return usb.bulk_left(arm) == 0; }));
    usb.unplug(arm);
    std::array<std::byte, 200> buffer{};
    CHECK(transport->read_bulk(buffer, 5s) == 100);
    CHECK_THROWS_AS(transport->read_bulk(buffer, 5s), device::Disconnected);
    CHECK_THROWS_AS(transport->read_report(buffer, 1ms), device::Disconnected);
    CHECK_THROWS_AS(transport->write_report(buffer), device::Disconnected);
    CHECK_THROWS_AS(transport->get_feature(buffer), device::Disconnected);
    CHECK_THROWS_AS(transport->set_feature(buffer), device::Disconnected);
    CHECK_THROWS_AS(device::open_transport(arm.endpoint()), device::Disconnected);
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("a signal during a transfer does not disconnect the arm") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  usb.send_report(arm, Bytes(5, std::byte{1}));
  Bytes report(8);
  arm.interruptions = 3;
  CHECK(transport->read_report(report, 5s) == 5);
  arm.interruptions = 3;
  CHECK_NOTHROW(transport->write_report(bytes_of(protocol::ForceReport{})));
  CHECK(arm.written.size() == 1);
  CHECK(arm.interruptions == 0);
}

TEST_CASE("an arm that went away before its scope is claimed is disconnected") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  SUBCASE("and another one came") {
    arm.serial_number = std::string("B");
    CHECK_THROWS_AS(transport->claim_scope(), device::Disconnected);
  }
  SUBCASE("while its transfers begin") {
    usb.unplug(arm);
    CHECK_THROWS_AS(transport->claim_scope(), device::Disconnected);
  }
}

TEST_CASE("an interface that can not be had for another reason than its use is a device that went away") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  {
    const auto transport = device::open_transport(arm.endpoint());
    SUBCASE("the claim fails") { arm.claim_result = LIBUSB_ERROR_NO_DEVICE; }
    SUBCASE("its configuration can not be read") { arm.bulk_fails = true; }
    CHECK_THROWS_AS(transport->claim_scope(), device::Disconnected);
    CHECK(usb.endpoints_under_way(arm).empty());
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("a session reconnects after a scope failure and continues with the scope") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  answer_as_inkwell(arm);
  std::atomic<int> searches = 0;
  std::atomic<bool> is_mended = false;
  {
    device::Session session([&]() -> std::optional<device::Endpoint> {
      ++searches;
      if (searches > 1 && !is_mended) return std::nullopt;
      return arm.endpoint();
    });
    session.select_signals({protocol::Signal::force_N});
    REQUIRE(eventually([&] { return !usb.endpoints_under_way(arm).empty(); }));
    usb.set_bulk_fails(arm, true);
    REQUIRE(eventually([&] { return searches > 1; }));
    CHECK(usb.endpoints_under_way(arm).empty());
    usb.set_bulk_fails(arm, false);
    is_mended = true;
    CHECK(eventually([&] { return !usb.endpoints_under_way(arm).empty(); }));
    CHECK(eventually([&] { return session.status().connection == device::Connection::connected; }));
    const int searches_before = searches;
    usb.send_bulk(arm, bulk_number(1));  // may be the rest of a frame that began earlier
    usb.send_bulk(arm, bulk_number(2));  // malformed; the session counts it half a second later
    CHECK(eventually([&] { return session.status().scope_frames_malformed == 1; }));
    CHECK(searches == searches_before);
  }
  CHECK(usb.open_things == 0);
}

TEST_CASE("read_pose with a negative time-out returns immediately") {
  FakeUsb usb;
  device::Device arm(device::open_transport(usb.add_arm("A").endpoint()));
  CHECK_FALSE(arm.read_pose(-1ms));
}

TEST_CASE("a reader that stops reading the scope loses the oldest transfers, and the stored amount is limited") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  transport->claim_scope();
  constexpr int kept = 682;
  for (int i = 0; i < kept + 3; ++i) usb.send_bulk(arm, bulk_number(i % 100));
  REQUIRE(eventually([&] { return usb.bulk_left(arm) == 0; }));
  std::array<std::byte, 200> buffer{};
  int count = 0;
  while (transport->read_bulk(buffer, count == 0 ? 5s : 100ms) > 0) {
    if (count == 0) CHECK(std::to_integer<int>(buffer[0]) <= 3);
    ++count;
  }
  CHECK(count >= kept);
  CHECK(count <= kept + 1);  // the newest transfer may have arrived during the first read
}

TEST_CASE("reports pass through hidapi unchanged") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  CHECK(transport->endpoint().serial_number == "A");
  Bytes report(8, std::byte{7});
  CHECK(transport->read_report(report, 1ms) == 0);
  usb.send_report(arm, Bytes(5, std::byte{1}));
  CHECK(transport->read_report(report, 5s) == 5);
  CHECK(report[4] == std::byte{1});
  CHECK(report[5] == std::byte{7});

  const auto check_sent = [&](const Bytes& sent, const Bytes& received, std::size_t padded_length) {
    CHECK(received.size() == (usb.is_windows ? padded_length : sent.size()));
    CHECK(std::ranges::equal(sent, std::span(received).first(sent.size())));
    CHECK(std::ranges::all_of(received.begin() + static_cast<std::ptrdiff_t>(sent.size()), received.end(),
                              [](std::byte byte) { return byte == std::byte{0}; }));
  };
  const auto force = bytes_of(protocol::ForceReport{});
  transport->write_report(force);
  REQUIRE(arm.written.size() == 1);
  check_sent(force, arm.written[0], protocol::longest_report(protocol::ReportKind::output));
  arm.features[static_cast<std::uint8_t>(protocol::ReportId::black_box_rows)] = {};
  const auto request = bytes_of(protocol::BlackBoxRequest{.first_row = 3});
  transport->set_feature(request);
  check_sent(request, arm.features[static_cast<std::uint8_t>(protocol::ReportId::black_box_rows)],
             sizeof(protocol::BlackBoxRowsReport));
}

TEST_CASE("a feature report is limited to the requested and the received length") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  Bytes report(8, std::byte{7});
  arm.features[7] = Bytes(4, std::byte{7});
  CHECK(transport->get_feature(report) == 4);
  arm.features[7] = Bytes(100, std::byte{9});
  CHECK(transport->get_feature(report) == 8);
  CHECK(report == Bytes(8, std::byte{9}));
}

TEST_CASE("a refused request is distinguished from an unplugged cable by the device alone, with hidapi's text") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  const auto transport = device::open_transport(arm.endpoint());
  Bytes report(8, std::byte{7});
  const auto check_refused = [&] {
    for (const auto& said : {message_of<device::Stalled>([&] { transport->get_feature(report); }),
                             message_of<device::Stalled>([&] { transport->set_feature(report); })}) {
      CHECK(contains(said, "refused a USB request"));
      CHECK(contains(said, "The system reports: not transferred"));
    }
  };
  SUBCASE("it answers another request") {
    arm.features[static_cast<std::uint8_t>(protocol::ReportId::information)] = Bytes(4);
    arm.hides = true;  // ignored, because the device answers
    check_refused();
  }
  SUBCASE("it answers none, and is listed") { check_refused(); }
  SUBCASE("it is listed no more") {
    arm.hides = true;
    const auto said = message_of<device::Disconnected>([&] { transport->get_feature(report); });
    CHECK(contains(said, "was unplugged"));
    CHECK(contains(said, "The system reports: not transferred"));
    CHECK_THROWS_AS(transport->set_feature(report), device::Disconnected);
  }
}

TEST_CASE("an arm that hidapi lists but cannot open has no permission, and an unlisted arm is disconnected") {
  FakeUsb usb;
  auto& arm = usb.add_arm("A");
  arm.denies_hid = true;
  const auto said = message_of<device::NoPermission>([&] { device::open_transport(arm.endpoint()); });
  CHECK(contains(said, "60-inkwell.rules"));
  CHECK(contains(said, "The system reports: not opened"));
  arm.hides = true;
  CHECK_THROWS_AS(device::open_transport(arm.endpoint()), device::Disconnected);
  CHECK(usb.open_things == 0);
}

TEST_CASE("a device that cannot be opened: each system has its own reason and remedy") {
  constexpr char in_use[] = "Close the other one.";
  const auto refuse = [&](int code, const device::UsbRules& rules) {
    return [=, &rules] { device::throw_libusb_refusal(code, in_use, rules); };
  };
  for (const auto* rules : {&device::linux_usb_rules, &device::windows_usb_rules}) {
    CHECK(message_of<device::InUse>(refuse(LIBUSB_ERROR_BUSY, *rules)) == in_use);
    CHECK(contains(message_of<device::Disconnected>(refuse(LIBUSB_ERROR_NO_DEVICE, *rules)), "unplugged"));
    for (const int code : {LIBUSB_ERROR_NOT_SUPPORTED, LIBUSB_ERROR_NOT_FOUND})
      CHECK(contains(message_of<device::NoPermission>(refuse(code, *rules)), rules->driver_advice));
  }
  CHECK(contains(message_of<device::NoPermission>(refuse(LIBUSB_ERROR_ACCESS, device::linux_usb_rules)), "udev"));
  CHECK(message_of<device::InUse>(refuse(LIBUSB_ERROR_ACCESS, device::windows_usb_rules)) == in_use);
  const auto deny = [](const device::UsbRules& rules) {
    return [&rules] { device::throw_hidapi_refusal("/path", "", rules); };
  };
  CHECK(contains(message_of<device::NoPermission>(deny(device::linux_usb_rules)), "udev"));
  CHECK(contains(message_of<device::InUse>(deny(device::windows_usb_rules)), "other program"));
  CHECK(contains(device::windows_usb_rules.driver_advice, "WinUSB"));
}
