// Time limits of a USB/IP connection.
#include <doctest/doctest.h>

#include <sys/socket.h>

#include <array>
#include <chrono>

#include "host/client/device/usbip_connection.hpp"
#include "protocol/usbip/messages.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"
#include "tests/host/client/device/local_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;

TEST_CASE("a request without an answer in time is unlinked, and the connection continues") {
  FakeUsbipServer server;
  device::UsbipConnection connection({"127.0.0.1", server.port()}, "1-1", 50ms);
  connection.start([](const std::string&) {});
  const auto device_descriptor = [&] {
    return connection.control_in(device::setup::get_descriptor(device::setup::DescriptorType::device, 0, 18));
  };
  server.holds_requests = true;
  CHECK(contains(message_of<device::Error>(device_descriptor), "did not answer a request in 0.05 s"));
  CHECK(eventually([&] { return server.transfers_taken_back() == 1; }));
  CHECK(server.waiting_transfers(0) == 0);
  server.holds_requests = false;
  CHECK(eventually([&] {  // 50 ms can be too short on a busy computer
    try {
      return device_descriptor().size() == 18;
    } catch (const device::Error&) {
      return false;
    }
  }));
}

TEST_CASE("a request with a truncated answer immediately raises Disconnected") {
  LocalServer server([](int client) {
    const auto send_all = [&](const auto& message, std::size_t size) { send(client, &message, size, MSG_NOSIGNAL); };
    usbip::ImportRequest import;
    if (recv(client, &import, sizeof import, MSG_WAITALL) != sizeof import) return;
    const usbip::OperationHeader reply{.operation = usbip::Operation::reply_import};
    send_all(reply, sizeof reply);
    send_all(usbip::Device{}, sizeof(usbip::Device));
    usbip::Submit submit;
    if (recv(client, &submit, sizeof submit, MSG_WAITALL) != sizeof submit) return;
    usbip::ReturnSubmit answer{.actual_length = 18u};
    answer.header.sequence = submit.header.sequence;
    send_all(answer, sizeof answer);
    send_all(std::array<std::byte, 4>{}, 4);
    shutdown(client, SHUT_RDWR);
  });
  device::UsbipConnection connection({"127.0.0.1", server.port()}, "1-1");
  connection.start([](const std::string&) {});
  CHECK_THROWS_AS(connection.control_in(device::setup::get_descriptor(device::setup::DescriptorType::device, 0, 18)),
                  device::Disconnected);
}
