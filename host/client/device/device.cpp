#include "host/client/device/device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include <signal.h>
#include <unistd.h>

#include <fmt/format.h>

#include "host/client/device/board_timeout.hpp"
#include "host/client/device/wide_counter.hpp"
#include "host/client/process/fork.hpp"

#include "host/client/device/feature_reports.hpp"
#include "host/client/device/sleep_inhibitor.hpp"

namespace inkwell::device {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using protocol::Command;
using protocol::ReportId;

constexpr std::int64_t heartbeat_periods = protocol::servo_rate_Hz / 100;
/// Time limit while the board is busy.
BoardTimeout busy_limit() { return {2.0, 2s}; }
constexpr auto claim_poll_interval = 5ms;
/// Time limits in board time. During the second limit, the force decreases to zero.
constexpr std::int64_t command_patience_periods = protocol::servo_rate_Hz / 2;
constexpr std::int64_t landing_patience_periods = 2 * protocol::servo_rate_Hz;
constexpr std::uint32_t self_test_patience_periods = protocol::servo_rate_Hz / 2;
/// A claim without signs of life expires within this time.
BoardTimeout claim_limit() { return {1.5 * static_cast<double>(protocol::claim_expiry_s), 2s}; }

/// Claims of the Device objects in this process. They show which Device object drives the arm. Two virtual boards with
/// the same seed have the same claim.
class OwnClaims {
 public:
  void add(std::uint32_t digest, int object) {
    const std::lock_guard lock(mutex_);
    objects_.emplace(digest, object);
  }
  void remove(std::uint32_t digest, int object) {
    const std::lock_guard lock(mutex_);
    objects_.erase({digest, object});
  }
  std::optional<int> find(std::uint32_t digest) const {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.lower_bound({digest, 0});
    return found == objects_.end() || found->first != digest ? std::nullopt : std::optional(found->second);
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::pair<std::uint32_t, int>> objects_;
};

std::atomic<OwnClaims*> claims_of_process = nullptr;

/// This object is never destroyed, because destructors of static objects may close arms. A forked child creates an
/// empty object.
OwnClaims& own_claims() {
  static const bool is_made = [] {
    claims_of_process = new OwnClaims;
    process::at_fork([] { claims_of_process = new OwnClaims; });
    return true;
  }();
  static_cast<void>(is_made);
  return *claims_of_process;
}

/// Returns false if this computer has no process with this number.
bool may_exist(std::uint32_t process_id) { return kill(static_cast<pid_t>(process_id), 0) == 0 || errno != ESRCH; }

int next_object() {
  static std::atomic<int> opened = 0;
  return ++opened;
}

/// The members differ between Device objects.
struct OwnNumbers {
  std::uint32_t claim, ticket;
  std::uint16_t transaction_ticket;

  explicit OwnNumbers(std::optional<std::uint64_t> seed) {
    if (seed)
      draw(std::mt19937_64(*seed));
    else
      draw(std::random_device());
  }

 private:
  void draw(auto&& source) {
    do claim = static_cast<std::uint32_t>(source());
    while (claim == 0);
    ticket = static_cast<std::uint32_t>(source());
    transaction_ticket = static_cast<std::uint16_t>(source());
  }
};

std::string own_program_name() {
  std::string name;
  std::getline(std::ifstream("/proc/self/comm"), name);
  return name;
}

std::string refusal_sentence(const protocol::TransactionReport& report) {
  const auto& refusal = protocol::info(report.refusal);
  const auto parameter = protocol::find_parameter(report.parameter_id);
  if (!parameter) return fmt::format("The device refused the parameters: {} {}", refusal.cause, refusal.remedy);
  const auto& row = info(*parameter);
  return fmt::format("The device refused {} = {}: {} {} Its range is {} to {}{}{}.", row.name, report.value,
                     refusal.cause, refusal.remedy, row.minimum, row.maximum, row.unit.empty() ? "" : " ", row.unit);
}

}  // namespace

Refused::Refused(const protocol::TransactionReport& refusal) : Error(refusal_sentence(refusal)), report(refusal) {}

struct Device::Implementation {
  std::shared_ptr<const ForceLaw> force_law;  ///< set before the device is used
  const int object = next_object();
  const std::uint32_t own_claim;
  const process::Origin origin;
  std::atomic<bool> drives = false;
  std::atomic<std::uint32_t> driver_changes = 0;  ///< DriverReport::changes when this object claimed the arm
  std::atomic<std::uint32_t> newest_sequence = 0;
  std::mutex feature_mutex;  ///< guards each transaction until its report is read
  std::mutex output_mutex;   ///< guards the next four members
  std::uint32_t ticket;
  std::uint8_t token = 0;
  std::uint32_t force_sequence = 0;
  std::int64_t last_output_period = 0;
  std::atomic<std::int64_t> newest_period = 0;  ///< newest board time from a report
  WideCounter time_periods, sequence;
  std::uint16_t transaction_ticket;  ///< guarded by feature_mutex
  mutable std::mutex scope_mutex;    ///< guards the scope's selection and decoder
  ScopeDecoder decoder;
  mutable std::mutex link_mutex;  ///< guards `link` and is locked last
  std::shared_ptr<Transport> link;
  SleepInhibitor sleep_inhibitor;  ///< prevents sleep while this object drives a real arm with force

  explicit Implementation(std::unique_ptr<Transport> transport)
      : Implementation(OwnNumbers(transport->endpoint().seed), std::move(transport)) {}
  Implementation(const OwnNumbers& numbers, std::unique_ptr<Transport>&& transport)
      : own_claim(numbers.claim),
        ticket(numbers.ticket),
        transaction_ticket(numbers.transaction_ticket),
        link(std::move(transport)) {}

  /// Returns the current link. The returned pointer keeps the link alive.
  std::shared_ptr<Transport> transport() const {
    const std::lock_guard lock(link_mutex);
    return link;
  }

  ForceLaw read_force_law() {
    protocol::ForceLawReport header{};
    get(header, "force law");
    // The device pads its report to the requested length.
    std::vector<std::byte> report(std::clamp<std::size_t>(header.size, 1, protocol::force_law_report_maximum));
    report[0] = static_cast<std::byte>(ReportId::force_law);
    report.resize(std::min(report.size(), transport()->get_feature(report)));
    return parse_force_law(report);
  }

  template <class Report>
  void get(Report& report, const char* what) {
    const std::size_t length = transport()->get_feature(writable_bytes(report));
    if (length < sizeof report) throw too_short(what, length, sizeof report);
  }

  /// Reads black-box rows from `first_row` on. Requires feature_mutex. Repeats the request if another program has
  /// requested other rows in the meantime.
  protocol::BlackBoxRowsReport rows_from(std::size_t first_row) {
    constexpr int tries = 100;
    const protocol::BlackBoxRequest request{.first_row = static_cast<std::uint16_t>(first_row)};
    auto result = protocol::RequestResult::accepted;
    for (int i = 0; i < tries; ++i) {
      transport()->set_feature(std::as_bytes(std::span(&request, 1)));
      protocol::BlackBoxRowsReport report{};
      get(report, "black box");
      result = static_cast<protocol::RequestResult>(report.result);
      if (result == protocol::RequestResult::accepted && report.first_row == request.first_row) return report;
    }
    if (result != protocol::RequestResult::accepted) throw refused("a request for rows of the black box", result);
    throw InUse("Another program reads the black box continuously. Close that program and try again.");
  }

  /// Assigns a token to the command, calls `before`, and sends the command.
  template <class Before>
  std::uint8_t send(protocol::CommandReport& command, Before before) {
    const std::lock_guard lock(output_mutex);
    token = token == 255 ? 1 : static_cast<std::uint8_t>(token + 1);  // 0: no command yet
    command.report_id = ReportId::command;
    command.version = protocol::protocol_version;
    command.token = token;
    command.claim = claim();
    before();
    write(command);
    return token;
  }
  std::uint8_t send(protocol::CommandReport& command) {
    return send(command, [] {});
  }

  /// Requires output_mutex. Each output report counts as a sign of life.
  template <class Report>
  void write(const Report& report) {
    transport()->write_report(std::as_bytes(std::span(&report, 1)));
    last_output_period = newest_period;
  }

  /// Returns 0 while this object does not drive the arm.
  std::uint32_t claim() const { return drives ? own_claim : 0; }

  /// Reads the board time. Requires feature_mutex.
  std::int64_t now_periods() {
    protocol::DriverReport report{};
    get(report, "driver");
    return time_periods.note(report.time_periods);
  }

  protocol::DriverReport driver_report() {
    const std::unique_lock lock(feature_mutex);
    return driver_report(lock);
  }
  protocol::DriverReport driver_report(const std::unique_lock<std::mutex>&) {
    protocol::DriverReport report{};
    get(report, "driver");
    return report;
  }

  void request(protocol::ClaimOperation operation) {
    protocol::ClaimReport report{};
    report.operation = operation;
    report.claim = own_claim;
    report.process_id = static_cast<std::uint32_t>(getpid());
    own_program_name().copy(report.program, protocol::program_name_maximum);
    const std::lock_guard lock(feature_mutex);
    transport()->set_feature(std::as_bytes(std::span(&report, 1)));
  }

  bool is_own(const protocol::DriverReport& report) const {
    return report.is_driven != 0 && report.claim_digest == protocol::digest_of(own_claim);
  }

  Driver driver_in(const protocol::DriverReport& report) const {
    char name[protocol::program_name_maximum + 1];
    const std::size_t length = protocol::copy_program_name(report.program, name);
    return {.program = std::string(name, length),
            .process_id = report.process_id,
            .driven_s = static_cast<double>(report.driven_s),
            .object = own_claims().find(report.claim_digest),
            .is_this_device = is_own(report)};
  }

  std::optional<Driver> driver_if_any(const protocol::DriverReport& report) const {
    return report.is_driven == 0 ? std::nullopt : std::optional(driver_in(report));
  }

  InUse driven_by_another() {
    const auto report = driver_report();
    if (report.is_driven == 0 || is_own(report))
      return InUse("This program does not drive the arm any more. Try again.");
    const Driver driver = driver_in(report);
    return InUse(fmt::format(
        "The arm is driven by {}. {}", driver_text(driver),
        driver.object ? "Use that object, or close it first." : "Close that program, or take the arm over from it."));
  }

  protocol::DriverReport answer_to(protocol::ClaimOperation operation) {
    request(operation);
    return driver_report();
  }

  /// Waits until the claim of a killed program has expired. Returns false if the claim is renewed or the program may
  /// still exist.
  bool outlives(const protocol::DriverReport& driven) {
    if (may_exist(driven.process_id)) return false;
    auto limit = claim_limit();
    WideCounter driven_periods;
    auto now = driven;
    while (now.is_driven != 0 && now.claim_digest == driven.claim_digest) {
      if (limit.update_time(driven_periods.note(now.time_periods))) return false;
      std::this_thread::sleep_for(claim_poll_interval);
      now = driver_report();
    }
    return true;
  }

  void become_driver(protocol::ClaimOperation operation) {
    auto report = answer_to(operation);
    while (!is_own(report) && outlives(report)) report = answer_to(operation);
    if (!is_own(report)) {
      lose_claim();
      throw driven_by_another();
    }
    own_claims().add(report.claim_digest, object);
    driver_changes = report.changes;
    if (!transport()->endpoint().is_virtual) sleep_inhibitor.prepare();
    drives = true;
  }

  void lose_claim() {
    drives = false;
    sleep_inhibitor.follow(false);
    own_claims().remove(protocol::digest_of(own_claim), object);
  }

  /// Reads an input report. Releases the sleep inhibitor if the device is disconnected.
  std::size_t read_report(std::span<std::byte> report, std::chrono::milliseconds timeout) {
    try {
      return transport()->read_report(report, timeout);
    } catch (const Disconnected&) {
      sleep_inhibitor.follow(false);
      throw;
    }
  }

  /// Compares the driver parity of the pose with the expected parity. Reads the claim if the parities differ.
  void check_claim(const protocol::PoseReport& pose) {
    if (!drives || pose.driver_parity == (driver_changes & 1u)) return;
    // This function must not wait for the mutex, because the mutex owner may wait for the next pose in lock step.
    const std::unique_lock lock(feature_mutex, std::try_to_lock);
    if (!lock) return;  // the next pose also shows the parity
    const auto report = driver_report(lock);
    if (is_own(report))
      driver_changes = report.changes;
    else
      lose_claim();
  }

  protocol::RequestResultsReport request_results() {
    protocol::RequestResultsReport report{};
    {
      const std::lock_guard lock(feature_mutex);
      get(report, "command results");
    }
    newest_period = time_periods.note(report.time_periods);
    return report;
  }

  /// Requires output_mutex.
  std::uint32_t next_ticket() { return ticket = ticket == 0xFFFFFFFFu ? 1 : ticket + 1; }

  /// Returns std::nullopt if the report contains no result of this request. The board may not have received the
  /// request, or newer results may have replaced the result.
  static std::optional<protocol::RequestResult> result_in(const protocol::RequestResultsReport& report,
                                                          std::uint32_t of_ticket) {
    const auto* entry = std::ranges::find(report.entries, of_ticket, &protocol::RequestResultEntry::ticket);
    return entry == std::end(report.entries) ? std::nullopt : std::optional(entry->result);
  }

  static Error refused(const char* what, protocol::RequestResult result) {
    const auto& row = info(result);
    return Error(fmt::format("The board refused {}. {} {}", what, row.meaning, row.remedy));
  }

  /// Sends the command and waits for its final result.
  protocol::RequestResult result_of(protocol::CommandReport& command) {
    send(command, [&] { command.ticket = next_ticket(); });
    std::optional<std::uint32_t> begin_periods;
    for (;;) {
      const auto report = request_results();
      if (!begin_periods) begin_periods = report.time_periods;
      const auto result = result_in(report, command.ticket);
      if (result && *result != protocol::RequestResult::waiting) return *result;
      if (report.time_periods - *begin_periods > command_patience_periods)
        throw Error("The board did not execute a command. Reset the board and try again.");
    }
  }

  void carry_out(protocol::CommandReport& command) {
    using enum protocol::RequestResult;
    auto limit = busy_limit();
    for (;;) {
      const auto result = result_of(command);
      if (result == carried_out) return;
      if (result == not_the_driver) throw driven_by_another();
      if (result != busy || limit.update_time(newest_period.load())) throw refused("a command", result);
    }
  }

  protocol::RequestResult result_of(protocol::ShapesReport& shapes) {
    {
      const std::lock_guard lock(output_mutex);
      shapes.ticket = next_ticket();
    }
    {
      const std::lock_guard lock(feature_mutex);
      transport()->set_feature(
          std::as_bytes(std::span(&shapes, 1))
              .first(protocol::shapes_report_size(shapes.plane_count, shapes.solid_count, shapes.material_count)));
    }
    // If the result is missing, the caller sends the shapes again.
    return result_in(request_results(), shapes.ticket).value_or(protocol::RequestResult::busy);
  }

  protocol::TransactionReport transaction_report() {
    protocol::TransactionReport report{};
    report.report_id = ReportId::transaction;
    get(report, "transaction");
    return report;
  }

  protocol::ParameterSet read_parameters(ReportId id) {
    const std::lock_guard lock(feature_mutex);
    protocol::ParametersReport report{};
    report.report_id = id;
    const std::size_t count = protocol::parameter_count + (force_law ? force_law->parameters.size() : 0);
    const std::size_t size = protocol::parameters_report_size(count);
    const std::size_t length = transport()->get_feature(writable_bytes(report).first(size));
    const bool is_whole = length >= size && report.version == protocol::protocol_version && report.count == count;
    if (!is_whole)
      throw Incompatible(
          "The device's parameters do not match this companion. Flash the firmware that belongs to this companion.");
    protocol::ParameterSet set = protocol::default_parameters();
    for (std::size_t i = 0; i < report.count; ++i)
      if (const auto parameter = protocol::find_parameter(report.entries[i].id))
        set[*parameter] = report.entries[i].value;
    return set;
  }

  /// The transaction has no entries, because the operation sets every parameter.
  AcceptedTransaction transact(protocol::ParameterOperation operation) {
    protocol::ParametersReport report{};
    report.report_id = ReportId::parameters;
    report.operation = operation;
    report.version = protocol::protocol_version;
    return transact(report);
  }

  /// The device processes a transaction before it acknowledges the data. The report that is read next therefore belongs
  /// to this transaction.
  AcceptedTransaction transact(protocol::ParametersReport& report) {
    report.claim = claim();
    const auto bytes = std::as_bytes(std::span(&report, 1)).first(protocol::parameters_report_size(report.count));
    std::unique_lock lock(feature_mutex);
    auto limit = busy_limit();
    for (;;) {
      report.ticket = ++transaction_ticket;
      transport()->set_feature(bytes);
      const auto result = transaction_report();
      if (result.ticket != report.ticket) {
        // Another program has sent a transaction in the meantime, so the result is unknown. The loop sends this
        // transaction again.
        if (limit.update_time(now_periods()))
          throw InUse("Other programs change parameters continuously. Close these programs.");
        continue;
      }
      if (result.refusal == protocol::Refusal::not_the_driver) {
        lock.unlock();
        throw driven_by_another();
      }
      if (result.refusal == protocol::Refusal::accepted)
        return {result.transactions, time_periods.nearest(result.applied_at_periods)};
      if (result.refusal != protocol::Refusal::busy || limit.update_time(now_periods())) throw Refused(result);
    }
  }
};

std::unique_ptr<Device> Device::open(const Endpoint& endpoint) {
  auto device = std::make_unique<Device>(open_transport(endpoint));
  const auto information = device->information();
  const auto& report = information.report;
  if (information.protocol_version != protocol::protocol_version)
    throw Incompatible(
        fmt::format("The device uses protocol version {}, this companion uses version {}. Flash the firmware that "
                    "belongs to this companion, or use the companion of firmware {}.",
                    information.protocol_version, protocol::protocol_version, information.firmware_version),
        information.board_name);
  if (report.parameter_table_hash != protocol::parameter_table_hash ||
      report.signal_table_hash != protocol::signal_table_hash)
    throw Incompatible(
        fmt::format("Firmware {} and this companion have different parameters or signals, although both use protocol "
                    "version {}. Build both from the same source and flash the firmware again.",
                    information.firmware_version, protocol::protocol_version),
        information.board_name);
  auto law = device->implementation_->read_force_law();
  if (!join_tables(law))
    throw Error(
        fmt::format("This device has the force law {}, but this program already uses the force law {}. Close the other "
                    "arm or recording, or use a separate program for each force law.",
                    law.name, joined_force_law()));
  device->implementation_->force_law = std::make_shared<const ForceLaw>(std::move(law));
  // Without a known bus frame, the scope contains no old samples.
  if (const auto bus_frame = device->bus_frame())
    device->implementation_->decoder.forget_before(static_cast<std::uint32_t>(bus_frame->time_periods));
  return device;
}

Device::Device(std::unique_ptr<Transport> transport)
    : implementation_(std::make_unique<Implementation>(std::move(transport))) {}

Device::~Device() {
  try {
    release();
  } catch (const Error&) {  // the claim was lost with the device
  }
}

std::string driver_text(const Driver& driver) {
  const auto program =
      driver.object ? fmt::format("this program itself, through the arm that it opened as number {}", *driver.object)
                    : fmt::format("{} (process {})", driver.program, driver.process_id);
  return fmt::format("{}, which claimed it {:.0f} s ago", program, driver.driven_s);
}

std::optional<Driver> Device::driver() { return implementation_->driver_if_any(implementation_->driver_report()); }

bool Device::try_driver(std::optional<Driver>& driver) {
  auto& self = *implementation_;
  const std::unique_lock lock(self.feature_mutex, std::try_to_lock);
  if (lock) driver = self.driver_if_any(self.driver_report(lock));
  return lock.owns_lock();
}

void Device::claim() { implementation_->become_driver(protocol::ClaimOperation::claim); }

void Device::take_over() { implementation_->become_driver(protocol::ClaimOperation::take_over); }

void Device::release() {
  if (!implementation_->drives || !implementation_->origin.is_here()) return;
  implementation_->lose_claim();
  implementation_->request(protocol::ClaimOperation::release);
}

void Device::abandon() { implementation_->lose_claim(); }

bool Device::drives() const { return implementation_->drives; }

void Device::carry_out(Command command) {
  protocol::CommandReport report{};
  report.command = command;
  implementation_->carry_out(report);
}

void Device::carry_out(Command command, const protocol::TestPulse& pulse) {
  protocol::CommandReport report{};
  report.command = command;
  report.test = pulse;
  implementation_->carry_out(report);
}

void Device::stop() {
  carry_out(Command::stop);
  if (protocol::force_is_on(implementation_->request_results().state))
    throw Error("The force is on again: another program has switched it on. Close that program.");
}

void Device::disable_force() {
  carry_out(Command::disable_force);
  auto report = implementation_->request_results();
  const std::uint32_t begin_periods = report.time_periods;
  while (protocol::force_is_on(report.state)) {
    if (report.time_periods - begin_periods > landing_patience_periods)
      throw Error("The force is still on: another program switches it on again. Close that program.");
    keep_alive();
    report = implementation_->request_results();
  }
}

void Device::switch_force_off() {
  try {
    disable_force();
  } catch (const InUse&) {
    stop();
  }
}

void Device::take_link_of(Device& opened) {
  auto& self = *implementation_;
  auto& other = *opened.implementation_;
  if (self.force_law && other.force_law && *self.force_law->report != *other.force_law->report)
    throw Error(fmt::format("The reconnected board has the force law {} instead of {}. Open the arm again.",
                            other.force_law->name, self.force_law->name));
  std::shared_ptr<Transport> before;  // destroyed after the locks are released, because closing may be slow
  const std::scoped_lock lock(self.feature_mutex, self.output_mutex, self.scope_mutex);
  self.decoder = other.decoder;
  self.lose_claim();
  opened.continue_time(self.newest_period);
  self.time_periods = other.time_periods;
  self.sequence = other.sequence;
  self.newest_period = self.time_periods.newest();
  self.newest_sequence = other.newest_sequence.load();
  self.last_output_period = self.newest_period - heartbeat_periods;  // the next heartbeat is due immediately
  const std::lock_guard link_lock(self.link_mutex);
  before = std::exchange(self.link, std::move(other.link));
}

std::optional<BusFrame> Device::bus_frame() {
  const std::lock_guard lock(implementation_->feature_mutex);
  protocol::FrameReport report{};
  report.report_id = ReportId::frame;
  implementation_->get(report, "frame");
  if (report.is_known == 0) return std::nullopt;
  return BusFrame{implementation_->sequence.note(report.sequence),
                  implementation_->time_periods.note(report.time_periods), report.time_cycles};
}

void Device::continue_time(std::int64_t before_periods) { implementation_->time_periods.continue_from(before_periods); }

Information Device::information() {
  const std::lock_guard lock(implementation_->feature_mutex);
  Information information{};
  information.report = read_information(*implementation_->transport());
  const auto& version = information.report.firmware_version;
  information.firmware_version = fmt::format("{}.{}.{}", version[0], version[1], version[2]);
  information.protocol_version = information.report.version;
  information.board_name = protocol::board_name(information.report.board);
  information.serial_number = implementation_->transport()->endpoint().serial_number;
  information.force_law = implementation_->force_law;
  return information;
}

std::optional<Pose> Device::read_pose(std::chrono::milliseconds timeout) {
  auto& self = *implementation_;
  protocol::PoseReport report;
  const auto deadline = Clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    const std::size_t length = self.read_report(writable_bytes(report), std::max(left, 0ms));
    if (length == 0) return std::nullopt;
    if (length != sizeof report || report.report_id != ReportId::pose) continue;
    const Pose pose = widened(report, self.sequence.note(report.sequence), self.time_periods.note(report.time_periods));
    self.newest_period = pose.time_periods;
    self.newest_sequence = report.sequence;
    self.check_claim(report);
    self.sleep_inhibitor.follow(self.drives && protocol::force_is_on(report.state));
    return pose;
  }
}

std::uint8_t Device::send(Command command) {
  protocol::CommandReport report{};
  report.command = command;
  return implementation_->send(report);
}

void Device::keep_alive() {
  auto& self = *implementation_;
  {
    const std::lock_guard lock(self.output_mutex);
    // While board time is stopped, heartbeats would delay the next command.
    if (self.newest_period - self.last_output_period < heartbeat_periods) return;
  }
  send(Command::heartbeat);
}

std::uint8_t Device::send(Command command, const protocol::TestPulse& pulse) {
  protocol::CommandReport report{};
  report.command = command;
  report.test = pulse;
  return implementation_->send(report);
}

std::uint8_t Device::select_signals(std::span<const protocol::Signal> signals) {
  check_selection(signals);
  if (!signals.empty()) implementation_->transport()->claim_scope();
  protocol::CommandReport report{};
  report.command = Command::select_signals;
  report.selection = selection_of(signals);
  const auto token = implementation_->send(report, [&] {
    const std::lock_guard lock(implementation_->scope_mutex);
    implementation_->decoder.pass_time(static_cast<std::uint32_t>(implementation_->time_periods.newest()));
    implementation_->decoder.expect(report.token, {signals.begin(), signals.end()});
  });
  if (signals.empty()) implementation_->transport()->release_scope();
  return token;
}

bool Device::wait_until_written(std::chrono::milliseconds timeout) {
  return implementation_->transport()->wait_until_written(timeout);
}

void Device::send_force(const ForceRequest& request) {
  protocol::ForceReport report = force_report(request);
  const std::lock_guard lock(implementation_->output_mutex);
  report.claim = implementation_->claim();
  report.sequence = implementation_->force_sequence++;
  report.pose_sequence = request.pose_sequence.value_or(implementation_->newest_sequence);
  implementation_->write(report);
}

void Device::send_local_model(const LocalModel& model, const ForceRequest& force) {
  protocol::LocalModelReport report = local_model_report(model, force);
  const std::lock_guard lock(implementation_->output_mutex);
  report.claim = implementation_->claim();
  report.sequence = static_cast<std::uint16_t>(implementation_->force_sequence++);
  report.pose_sequence = static_cast<std::uint16_t>(force.pose_sequence.value_or(implementation_->newest_sequence));
  implementation_->write(report);
}

void Device::place_shapes(const Shapes& shapes) {
  using enum protocol::RequestResult;
  auto& self = *implementation_;
  protocol::ShapesReport report = shapes_report(shapes);
  report.claim = self.claim();
  auto limit = busy_limit();
  for (;;) {
    const auto result = self.result_of(report);
    if (result == accepted) return;
    if (result == not_the_driver) {
      self.lose_claim();
      throw self.driven_by_another();
    }
    if (result != busy || limit.update_time(self.newest_period.load())) throw self.refused("shapes", result);
  }
}

protocol::ParameterSet Device::parameters() { return implementation_->read_parameters(ReportId::parameters); }

protocol::ParameterSet Device::stored_parameters() { return implementation_->read_parameters(ReportId::stored); }

AcceptedTransaction Device::set_parameters(std::span<const ParameterChange> changes) {
  if (changes.size() > protocol::parameter_entries_maximum)
    throw Error(
        fmt::format("{} parameters are too many for one transaction. Give each parameter once.", changes.size()));
  protocol::ParametersReport report{};
  report.report_id = ReportId::parameters;
  report.operation = protocol::ParameterOperation::set;
  report.version = protocol::protocol_version;
  report.count = static_cast<std::uint16_t>(changes.size());
  for (std::size_t i = 0; i < changes.size(); ++i)
    report.entries[i] = {info(changes[i].first).id, 0, changes[i].second};
  return implementation_->transact(report);
}

AcceptedTransaction Device::restore_default_parameters() {
  return implementation_->transact(protocol::ParameterOperation::restore_defaults);
}

AcceptedTransaction Device::restore_stored_parameters() {
  return implementation_->transact(protocol::ParameterOperation::restore_stored);
}

protocol::StoreReport Device::store_report() {
  const std::lock_guard lock(implementation_->feature_mutex);
  protocol::StoreReport report{};
  implementation_->get(report, "parameter store");
  return report;
}

protocol::BlackBoxReport Device::black_box() {
  const std::lock_guard lock(implementation_->feature_mutex);
  protocol::BlackBoxReport report{};
  implementation_->get(report, "black box");
  if (report.row_count > protocol::black_box_rows_maximum || report.rows_before > report.row_count)
    throw Incompatible("The device's black box is damaged. Flash the firmware that belongs to this companion.");
  return report;
}

std::vector<protocol::BlackBoxRow> Device::black_box_rows(const protocol::BlackBoxReport& box) {
  const std::lock_guard lock(implementation_->feature_mutex);
  std::vector<protocol::BlackBoxRow> rows;
  while (rows.size() < box.row_count) {
    const auto report = implementation_->rows_from(rows.size());
    if (report.row_count == 0 || report.fault_periods != box.fault_periods)
      throw Error("The board discarded the black box while it was read, because the force was switched on.");
    const std::size_t count =
        std::min({std::size_t{report.row_count}, std::size(report.rows), box.row_count - rows.size()});
    rows.insert(rows.end(), report.rows, report.rows + count);
  }
  return rows;
}

protocol::SelfTestReport Device::read_self_test() {
  const std::lock_guard lock(implementation_->feature_mutex);
  protocol::SelfTestReport report{};
  implementation_->get(report, "self-test");
  return report;
}

protocol::SelfTestReport Device::self_test() {
  protocol::SelfTestReport report = read_self_test();
  const auto wait_while = [&](auto&& condition) {
    const std::uint32_t begin_periods = report.time_periods;
    while (condition() && report.time_periods - begin_periods < self_test_patience_periods) report = read_self_test();
    return !condition();
  };
  const auto it_runs = [&] { return report.is_running != 0; };
  wait_while(it_runs);  // wait for the end of a running self-test
  const std::uint32_t begun_before = report.tests_begun;
  carry_out(Command::self_test);
  if (!wait_while([&] { return report.tests_begun == begun_before; }))
    throw NotTested(
        "The board cannot run its self-test now. Switch the force off. If a fault is shown, correct its cause first: "
        "`inkwell fault` prints the cause.");
  if (!wait_while(it_runs))
    throw Error("The board's self-test does not finish. Report this with the firmware version.");
  return report;
}

std::optional<ScopeSamples> Device::read_scope(std::chrono::milliseconds timeout) {
  std::array<std::byte, protocol::scope_frame_maximum> scope_frame;
  const auto deadline = Clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    const std::size_t length = implementation_->transport()->read_bulk(scope_frame, std::max(left, 0ms));
    if (length == 0) return std::nullopt;
    const std::lock_guard lock(implementation_->scope_mutex);
    auto samples = implementation_->decoder.decode(std::span(scope_frame).first(length));
    if (!samples) continue;
    samples->first_period = implementation_->time_periods.nearest(static_cast<std::uint32_t>(samples->first_period));
    return samples;
  }
}

std::uint64_t Device::malformed_scope_frames() const {
  const std::lock_guard lock(implementation_->scope_mutex);
  return implementation_->decoder.malformed_frames();
}

}  // namespace inkwell::device
