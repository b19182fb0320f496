#include "firmware/record/black_box.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "firmware/control/signal_path/installed_force_law.hpp"

namespace inkwell::link {

namespace {

using protocol::Fault;
using protocol::State;

// FNV-1a, computed by words.
constexpr std::uint32_t hash_basis = 2166136261u;

std::uint32_t hash_words(std::uint32_t hash, const void* words, std::size_t bytes) {
  const auto* cursor = static_cast<const std::byte*>(words);
  for (std::size_t i = 0; i + sizeof(std::uint32_t) <= bytes; i += sizeof(std::uint32_t)) {
    std::uint32_t word;
    std::memcpy(&word, cursor + i, sizeof word);
    hash = (hash ^ word) * 16777619u;
  }
  return hash;
}

std::uint32_t check_of(const BlackBoxNotes::Cause& cause) {
  return hash_words(hash_basis, &cause, offsetof(BlackBoxNotes::Cause, check));
}

/// Checksum of row and row number. The row number distinguishes new rows from rows of an earlier run.
std::uint32_t check_of(const protocol::BlackBoxRow& row, std::uint32_t number) {
  return hash_words(hash_basis ^ number, &row, sizeof row);
}

bool is_intact(const BlackBoxSlot& slot, std::uint32_t number) { return slot.check == check_of(slot.row, number); }

/// Number of the row at the fault. Rows before the fault have smaller numbers.
constexpr std::uint32_t first_number_from_fault = 0x8000'0000;

/// Returns the number of the next row before the fault. After 24 days without a fault, the row number decreases by a
/// multiple of the ring size.
std::uint32_t number_after(std::uint32_t number, std::size_t ring_size) {
  const auto size = static_cast<std::uint32_t>(ring_size);
  return number + 1 < first_number_from_fault - size ? number + 1 : size + (number + 1) % size;
}

/// Compiler barrier. The compiler must not reorder writes across this call.
void in_this_order() { std::atomic_signal_fence(std::memory_order_seq_cst); }

void write(BlackBoxSlot& slot, std::uint32_t number, const Sample& sample) {
  slot.row.time_periods = sample.summary.periods;
  std::ranges::copy(sample.signals.values, slot.row.values);
  slot.check = check_of(slot.row, number);
  in_this_order();
}

/// Returns the hash of the tables and the memory layout. Rows of an image with another hash are ignored.
std::uint32_t hash_of_tables(std::size_t before, std::size_t from_fault) {
  const auto& law = control::installed_force_law;
  std::uint32_t hash =
      protocol::detail::fnv1a(hash_basis, {reinterpret_cast<const char*>(law.report), law.report_size});
  for (const std::size_t number :
       {std::size_t{protocol::protocol_version}, std::size_t{protocol::signal_table_hash}, before, from_fault})
    hash = protocol::detail::hash_number(hash, static_cast<std::uint32_t>(number));
  return hash;
}

}  // namespace

void BlackBox::start(Fault raised, const protocol::CrashFacts& crash) {
  tables_hash_ = hash_of_tables(ring_.size(), line_.size());
  if (notes_.tables_hash != tables_hash_) return restart_recording();
  const bool is_kept = notes_.cause.check == check_of(notes_.cause);
  if (!is_kept && raised == Fault::none) return restart_recording();

  // A reset may have interrupted any write. Only consecutive valid rows around the fault are used.
  while (rows_before_ < std::min<std::size_t>(ring_.size(), notes_.rows_written)) {
    const std::uint32_t number = notes_.rows_written - 1 - rows_before_;
    if (!is_intact(before(number), number)) break;
    ++rows_before_;
  }
  // The black box retains the signals of the first fault and the newest crash record.
  if (is_kept && crash.exception != 0) {
    ++notes_.cause.later_crashes;
    notes_.cause.crash = crash;
    notes_.cause.check = check_of(notes_.cause);
  }
  if (!is_kept) {
    notes_.rows_added = 0;
    start_fault_record(raised, rows_before_ != 0 ? before(notes_.rows_written - 1).row.time_periods : 0, true, crash);
  }
  while (rows_from_fault_ < std::min<std::size_t>(line_.size(), notes_.rows_added) &&
         is_intact(line_[rows_from_fault_], first_number_from_fault + rows_from_fault_))
    ++rows_from_fault_;
  phase_ = Phase::complete;
}

void BlackBox::follow() {
  const std::uint32_t recorded = samples_.recorded();
  if (recorded - followed_ > SampleRing::readable) followed_ = recorded - SampleRing::readable;
  for (; followed_ != recorded; ++followed_) record_sample(samples_[followed_]);
}

void BlackBox::record_sample(const Sample& sample) {
  const std::uint32_t period = sample.summary.periods;
  if (phase_ != Phase::recording && protocol::force_is_on(sample.summary.state)) restart_recording();
  switch (phase_) {
    case Phase::recording:
      if (sample.summary.state == State::fault) {
        rows_before_ = std::min(notes_.rows_written, static_cast<std::uint32_t>(ring_.size()));
        start_fault_record(sample.summary.fault, period, false, {});
        add_after_fault(sample);
      } else if (period % protocol::black_box_step_periods == 0) {
        write(before(notes_.rows_written), notes_.rows_written, sample);
        notes_.rows_written = number_after(notes_.rows_written, ring_.size());
      }
      break;
    case Phase::fault_seen: add_after_fault(sample); break;
    case Phase::complete: break;
  }
}

void BlackBox::restart_recording() {
  phase_ = Phase::recording;
  rows_before_ = rows_from_fault_ = 0;
  notes_.tables_hash = ~tables_hash_;
  in_this_order();
  notes_.cause = {};  // no fault, and an invalid checksum
  notes_.rows_written = notes_.rows_added = 0;
  in_this_order();
  notes_.tables_hash = tables_hash_;
}

void BlackBox::start_fault_record(Fault fault, std::uint32_t period, bool is_restart,
                                  const protocol::CrashFacts& crash) {
  phase_ = Phase::fault_seen;
  notes_.cause = {.fault = static_cast<std::uint32_t>(fault),
                  .period = period,
                  .is_restart = is_restart,
                  .later_crashes = 0,
                  .crash = crash,
                  .check = 0};
  notes_.cause.check = check_of(notes_.cause);
}

void BlackBox::add_after_fault(const Sample& sample) {
  const std::uint32_t since = sample.summary.periods - notes_.cause.period;
  const std::uint32_t slot_index = since / protocol::black_box_step_periods;
  if (since % protocol::black_box_step_periods == 0 && slot_index < line_.size()) {
    write(line_[rows_from_fault_], first_number_from_fault + rows_from_fault_, sample);
    notes_.rows_added = ++rows_from_fault_;
  }
  if (slot_index + 1 >= line_.size()) phase_ = Phase::complete;
}

protocol::BlackBoxReport BlackBox::report() const {
  protocol::BlackBoxReport report{};
  report.is_complete = phase_ == Phase::complete;
  report.is_restart = notes_.cause.is_restart != 0;
  report.fault = static_cast<Fault>(notes_.cause.fault);
  report.fault_periods = notes_.cause.period;
  report.later_crashes = notes_.cause.later_crashes;
  report.rows_before = static_cast<std::uint16_t>(rows_before_);
  report.row_count = static_cast<std::uint16_t>(row_count());
  report.crash = notes_.cause.crash;
  return report;
}

void BlackBox::select_rows(std::span<const std::byte> request) {
  protocol::BlackBoxRequest wanted{};
  std::memcpy(&wanted, request.data(), std::min(request.size(), sizeof wanted));
  const bool is_valid = request.size() >= sizeof wanted && wanted.version == protocol::protocol_version;
  result_ = is_valid ? protocol::RequestResult::accepted : protocol::RequestResult::malformed;
  if (is_valid) first_row_ = wanted.first_row;
}

protocol::BlackBoxRowsReport BlackBox::rows() const {
  protocol::BlackBoxRowsReport report{};
  report.result = static_cast<std::uint8_t>(result_) & 0xFu;
  report.first_row = first_row_;
  report.fault_periods = notes_.cause.period;
  for (std::uint32_t i = first_row_; i < row_count() && report.row_count < protocol::black_box_report_rows; ++i) {
    const std::uint32_t number = notes_.rows_written - rows_before_ + i;
    const BlackBoxSlot& slot = i < rows_before_ ? before(number) : line_[i - rows_before_];
    report.rows[report.row_count] = slot.row;
    report.row_count = (report.row_count + 1u) & 0xFu;
  }
  return report;
}

}  // namespace inkwell::link
