#include "tests/host/client/device/fake_usbip_server.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <span>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "protocol/scope.hpp"
#include "protocol/usbip/messages.hpp"

namespace inkwell::tests {
namespace {

bool receive(int socket, std::span<std::byte> data) {
  return data.empty() || recv(socket, data.data(), data.size(), MSG_WAITALL) == static_cast<ssize_t>(data.size());
}

template <class Message>
std::optional<Message> receive(int socket) {
  Message message;
  if (!receive(socket, std::as_writable_bytes(std::span(&message, 1)))) return std::nullopt;
  return message;
}

template <class Message>
void append(Bytes& bytes, const Message& message) {
  const auto added = usbip::bytes_of(message);
  bytes.insert(bytes.end(), added.begin(), added.end());
}

Bytes bytes(std::initializer_list<int> values) {
  Bytes result;
  for (int value : values) result.push_back(static_cast<std::byte>(value));
  return result;
}

constexpr std::uint32_t bus_number = 1, device_number = 2;
constexpr std::uint8_t hid_interface = 0, hid_out_endpoint = 1, scope_endpoint = 2;

/// Configuration descriptor of a HID interface (two interrupt endpoints) and a vendor interface (one bulk endpoint).
Bytes default_configuration() {
  return bytes({9, 2,    57,   0, 2,  1,    0,    0x80, 50,                       //
                9, 4,    0,    0, 2,  3,    0,    0,    0,                        //
                9, 0x21, 0x11, 1, 0,  1,    0x22, 64,   0,                        //
                7, 5,    0x81, 3, 64, 0,    1,    7,    5,  0x01, 3, 64,   0, 1,  //
                9, 4,    1,    0, 1,  0xFF, 0,    0,    0,  7,    5, 0x82, 2, 64, 0, 0});
}

Bytes string_descriptor(const std::string& text) {
  Bytes descriptor = bytes({static_cast<int>(2 + 2 * text.size()), 3});
  for (char character : text) {
    descriptor.push_back(static_cast<std::byte>(character));
    descriptor.push_back(std::byte{0});
  }
  return descriptor;
}

Bytes parameters_report(protocol::ReportId id, const protocol::ParameterSet& set) {
  protocol::ParametersReport report{};
  report.report_id = id;
  report.version = protocol::protocol_version;
  report.count = protocol::parameter_count;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i)
    report.entries[i] = {protocol::parameter_table[i].id, 0, set.values[i]};
  return bytes_of(report);
}

/// Returns the reply, cut to the requested length.
Bytes limited(const std::uint8_t (&setup)[8], Bytes reply) {
  const std::size_t length = setup[6] | static_cast<std::size_t>(setup[7]) << 8;
  reply.resize(std::min(reply.size(), length));
  return reply;
}

}  // namespace

FakeUsbipServer::FakeUsbipServer(const device::SocketAddress& where)
    : device_descriptor(bytes({18, 1, 0, 2, 0, 0, 0, 64, 0x09, 0x12, 1, 0, 0, 1, 1, 2, 3, 1})),
      configuration(default_configuration()),
      server_([this](int client) { serve(client); }, where) {
  information.report_id = protocol::ReportId::information;
  information.version = protocol::protocol_version;
  information.parameter_table_hash = protocol::parameter_table_hash;
  information.signal_table_hash = protocol::signal_table_hash;
  information.servo_rate_Hz = protocol::servo_rate_Hz;
  transaction_.report_id = protocol::ReportId::transaction;
  store.report_id = protocol::ReportId::store;
  bus_frame.is_known = 1;
}

device::Endpoint FakeUsbipServer::endpoint() const {
  return {device::Endpoint::Kind::usbip, "", "", "1-1", server_.address()};
}

void FakeUsbipServer::serve(int client) {
  {
    const std::lock_guard lock(mutex_);
    client_ = client;
  }
  serve_requests(client);
  const std::lock_guard lock(mutex_);
  client_ = -1;
  is_configured_ = false;
  waiting_.clear();
  ready_.clear();
}

void FakeUsbipServer::serve_requests(int client) {
  const auto request = receive<usbip::OperationHeader>(client);
  if (!request) return;
  if (silent) {
    while (receive<usbip::OperationHeader>(client)) {
    }
    return;
  }
  const bool imports_device = request->operation == usbip::Operation::request_import;
  std::optional<usbip::BusId> bus_id;
  if (imports_device && !(bus_id = receive<usbip::BusId>(client))) return;

  const usbip::Device device{.path = {path},
                             .bus_id = {"1-1"},
                             .bus_number = bus_number,
                             .device_number = device_number,
                             .speed = usbip::Speed::full,
                             .vendor_id = vendor_id,
                             .product_id = product_id,
                             .device_release = 0x0100,
                             .configuration = 1,
                             .configuration_count = 1,
                             .interface_count = 2};
  Bytes reply;
  const bool refused = imports_device && (refuses_import || bus_id->view() != "1-1");
  if (!imports_device) {
    append(reply, usbip::DeviceListReply{.device_count = 1});
    append(reply, device);
    for (int i = 0; i < device.interface_count; ++i) append(reply, usbip::Interface{});
  } else {
    append(reply,
           usbip::OperationHeader{.operation = usbip::Operation::reply_import,
                                  .status = refused ? usbip::OperationStatus::busy : usbip::OperationStatus::success});
    if (!refused) append(reply, device);
  }
  spoil_reply(reply);
  ::send(client, reply.data(), reply.size(), MSG_NOSIGNAL);
  if (imports_device && !refused) {
    {
      const std::lock_guard lock(mutex_);
      ++imports_;
    }
    serve_transfers(client);
  }
}

void FakeUsbipServer::serve_transfers(int client) {
  while (const auto submit = receive<usbip::Submit>(client)) {
    const std::uint32_t sequence = submit->header.sequence;
    if (submit->header.device != usbip::device_of(bus_number, device_number)) return;  // as the Linux server does
    if (submit->header.command == usbip::Command::unlink) {
      const std::lock_guard lock(mutex_);
      take_back(client, sequence, std::bit_cast<usbip::Unlink>(*submit).unlinked_sequence);
      continue;
    }
    if (submit->header.command != usbip::Command::submit) return;
    const auto endpoint = static_cast<std::uint8_t>(submit->header.endpoint);
    const bool is_in = submit->header.direction == usbip::Direction::in;
    const std::uint32_t length = submit->length;
    Bytes data(is_in ? 0 : length);
    if (!receive(client, data)) return;
    const std::lock_guard lock(mutex_);
    const bool is_transaction = endpoint == 0 && !is_in && submit->setup[1] == std::byte{9} && !data.empty();
    if (is_transaction && transactions_to_break_at > 0) {
      --transactions_to_break_at;
      on_break();
      return;
    }
    if (endpoint == 0 && holds_requests) {
      waiting_[endpoint].push_back(sequence);
    } else if (endpoint == 0) {
      std::uint8_t setup[8];
      std::memcpy(setup, submit->setup.data(), sizeof setup);
      const auto result = answer_control(setup, data);
      const Bytes empty;
      answer(client, sequence, result ? 0 : -EPIPE, result && is_in ? *result : empty,
             is_in ? 0 : static_cast<std::uint32_t>(data.size()));
    } else if (is_in && endpoint == scope_endpoint && scope_is_taken) {
      answer(client, sequence, -EBUSY, {}, 0);
    } else if (is_in) {
      waiting_[endpoint].push_back(sequence);
      match(endpoint);
    } else if (endpoint == hid_out_endpoint) {
      take_output(data);
      if (holds_outputs)
        held_outputs_.push_back(sequence);
      else
        answer(client, sequence, output_status, {}, static_cast<std::uint32_t>(data.size()));
    }
  }
}

void FakeUsbipServer::take_output(const Bytes& data) {
  const auto take = [&](auto report, auto& into) {
    std::memcpy(&report, data.data(), std::min(data.size(), sizeof report));
    into.push_back(report);
  };
  if (data[0] == std::byte{static_cast<std::uint8_t>(protocol::ReportId::force)})
    return take(protocol::ForceReport{}, forces_);
  take(protocol::CommandReport{}, commands_);
  if (!driver.permits(commands_.back().claim) && protocol::needs_claim(commands_.back().command))
    request_results.refuse(data);
  else
    request_results.note(data);
  const auto command = commands_.back().command;
  const bool is_for_store =
      command == protocol::Command::store_parameters || command == protocol::Command::factory_reset;
  if (is_for_store && !ignores_store) take_store_command(command);
}

void FakeUsbipServer::take_store_command(protocol::Command command) {
  ++store.commands;
  store.result = judge_store(command);
  if (store.result != protocol::StoreResult::done) return;
  ++store.records_written;
  if (command == protocol::Command::factory_reset) parameters = protocol::default_parameters();
  at_next_start = parameters;
}

void FakeUsbipServer::take_back(int client, std::uint32_t sequence, std::uint32_t unlinked_sequence) {
  usbip::ReturnUnlink reply{.status = 0};
  for (auto& [endpoint, waiting] : waiting_)
    if (std::erase(waiting, unlinked_sequence) > 0) reply.status = -ECONNRESET;
  reply.header.sequence = sequence;
  ++taken_back_;
  const auto bytes = usbip::bytes_of(reply);
  ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void FakeUsbipServer::match(std::uint8_t endpoint) {
  auto& waiting = waiting_[endpoint];
  auto& ready = ready_[endpoint];
  while (!waiting.empty() && !ready.empty()) {
    answer(client_, waiting.front(), 0, ready.front(), 0);
    waiting.pop_front();
    ready.pop_front();
  }
}

void FakeUsbipServer::answer(int client, std::uint32_t sequence, std::int32_t status, const Bytes& data,
                             std::uint32_t length) {
  usbip::ReturnSubmit header{.status = status,
                             .actual_length = data.empty() ? length : static_cast<std::uint32_t>(data.size())};
  header.header.sequence = sequence;
  Bytes reply;
  append(reply, header);
  reply.insert(reply.end(), data.begin(), data.end());
  constexpr std::size_t first = 10;  // a stream may deliver the reply in pieces
  ::send(client, reply.data(), first, MSG_NOSIGNAL);
  ::send(client, reply.data() + first, reply.size() - first, MSG_NOSIGNAL);
}

std::optional<Bytes> FakeUsbipServer::answer_control(const std::uint8_t (&setup)[8], const Bytes& data) {
  if (setup[0] == 0x80 && setup[1] == 6) {
    switch (setup[3]) {
      case 1: return limited(setup, device_descriptor);
      case 2: return limited(setup, configuration);
      case 3: return limited(setup, string_descriptor(setup[2] == 3 ? serial_number : "Inkwell haptic arm"));
      default: return std::nullopt;
    }
  }
  if (setup[0] == 0x00 && setup[1] == 9) {
    is_configured_ = std::byte{setup[2]} == configuration[5];
    return Bytes{};
  }
  return is_configured_ && setup[4] == hid_interface ? answer_report_request(setup, data) : std::nullopt;
}

std::optional<Bytes> FakeUsbipServer::answer_report_request(const std::uint8_t (&setup)[8], const Bytes& data) {
  if (setup[0] == 0xA1 && setup[1] == 1 && setup[3] == 3) {
    const auto id = static_cast<protocol::ReportId>(setup[2]);
    on_get(id, setup[6] | static_cast<std::size_t>(setup[7]) << 8);
    auto report = feature_report(id);
    if (report && spoil.contains(id)) spoil[id](*report);
    return report ? std::optional(limited(setup, *report)) : std::nullopt;
  }
  if (setup[0] == 0x21 && setup[1] == 9 && setup[2] == 0x14) {
    const auto result = judge_shapes();
    request_results.note_shapes(data, result);
    if (result == protocol::RequestResult::accepted) shapes_placed_.push_back(data);
    return Bytes{};
  }
  if (setup[0] == 0x21 && setup[1] == 9 && setup[2] == 0x1B) {
    driver.accept(data, bus_frame.time_periods);
    return Bytes{};
  }
  if (setup[0] == 0x21 && setup[1] == 9 && setup[2] == 0x11) {
    protocol::ParametersReport report{};
    std::memcpy(&report, data.data(), std::min(data.size(), sizeof report));
    transaction_.ticket = report.ticket;
    transaction_.refusal = judge(report);
    transaction_.parameter_id =
        transaction_.refusal == protocol::Refusal::accepted ? std::uint16_t{0} : report.entries[0].id;
    transaction_.value = report.entries[0].value;
    ++transaction_.transactions;
    if (transaction_.refusal == protocol::Refusal::accepted)
      transaction_.applied_at_periods = 100 * transaction_.transactions;
    if (transaction_.refusal != protocol::Refusal::accepted) return Bytes{};
    if (report.operation == protocol::ParameterOperation::restore_defaults) parameters = protocol::default_parameters();
    if (report.operation == protocol::ParameterOperation::restore_stored) parameters = at_next_start;
    for (std::size_t i = 0; i < report.count; ++i)
      if (const auto parameter = protocol::find_parameter(report.entries[i].id))
        parameters[*parameter] = report.entries[i].value;
    return stalls_accepted ? std::nullopt : std::optional(Bytes{});
  }
  return std::nullopt;
}

std::optional<Bytes> FakeUsbipServer::feature_report(protocol::ReportId id) {
  switch (id) {
    case protocol::ReportId::information: return bytes_of(information);
    case protocol::ReportId::transaction: return bytes_of(transaction_);
    case protocol::ReportId::frame: return bytes_of(bus_frame);
    case protocol::ReportId::black_box: return black_box ? std::optional(bytes_of(*black_box)) : std::nullopt;
    case protocol::ReportId::force_law:
      return Bytes(control::installed_force_law.report,
                   control::installed_force_law.report + control::installed_force_law.report_size);
    case protocol::ReportId::store: return bytes_of(store);
    case protocol::ReportId::driver: return bytes_of(driver.report(bus_frame.time_periods));
    case protocol::ReportId::request_results: return bytes_of(request_results.report);
    case protocol::ReportId::parameters: return parameters_report(id, parameters);
    case protocol::ReportId::stored: return parameters_report(id, at_next_start);
    default: return std::nullopt;
  }
}

void FakeUsbipServer::send(std::uint8_t endpoint, Bytes data) {
  const std::lock_guard lock(mutex_);
  ready_[endpoint].push_back(std::move(data));
  match(endpoint);
}

void FakeUsbipServer::fail(std::uint8_t endpoint, std::int32_t status) {
  const std::lock_guard lock(mutex_);
  answer(client_, waiting_[endpoint].front(), status, {}, 0);
  waiting_[endpoint].pop_front();
}

void FakeUsbipServer::answer_output() {
  const std::lock_guard lock(mutex_);
  answer(client_, held_outputs_.front(), output_status, {}, 0);
  held_outputs_.pop_front();
}

void FakeUsbipServer::send_unasked(std::span<const std::byte> bytes) {
  const std::lock_guard lock(mutex_);
  ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::vector<protocol::CommandReport> FakeUsbipServer::commands() {
  const std::lock_guard lock(mutex_);
  return commands_;
}

std::vector<protocol::ForceReport> FakeUsbipServer::forces() {
  const std::lock_guard lock(mutex_);
  return forces_;
}

std::vector<Bytes> FakeUsbipServer::shapes_placed() {
  const std::lock_guard lock(mutex_);
  return shapes_placed_;
}

std::size_t FakeUsbipServer::waiting_transfers(std::uint8_t endpoint) {
  const std::lock_guard lock(mutex_);
  return waiting_[endpoint].size();
}

std::size_t FakeUsbipServer::transfers_taken_back() {
  const std::lock_guard lock(mutex_);
  return taken_back_;
}

std::size_t FakeUsbipServer::transactions() {
  const std::lock_guard lock(mutex_);
  return transaction_.transactions;
}

std::size_t FakeUsbipServer::imports() {
  const std::lock_guard lock(mutex_);
  return imports_;
}

Bytes scope_frame(std::uint8_t token, std::uint32_t first_period, float value) {
  protocol::ScopeFrameHeader header{};
  header.first_period = first_period;
  header.sample_count = 1;
  header.signal_count = 1;
  header.selection_token = token;
  header.length = sizeof header + sizeof value;
  Bytes frame = bytes_of(header);
  const Bytes sample = bytes_of(value);
  frame.insert(frame.end(), sample.begin(), sample.end());
  return frame;
}

bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 60'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

}  // namespace inkwell::tests
