// The black box contains all signals from 100 ms before a fault to 100 ms after the fault. The signals survive a reset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/record/sample_ring.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::link {

/// Retained data of the black box. The memory content is undefined after power-on. Cause and rows therefore have
/// checksums. Data with a wrong checksum is ignored.
struct BlackBoxNotes {
  struct Cause {
    std::uint32_t fault;  ///< protocol::Fault
    std::uint32_t period;
    std::uint32_t is_restart;
    std::uint32_t later_crashes;
    protocol::CrashFacts crash;
    std::uint32_t check;
  };
  std::uint32_t tables_hash;  ///< hash of the tables that define the rows; with another hash all data is ignored
  Cause cause;                ///< a black box exists if the checksum of this member matches
  /// Number of rows before the fault. The ring contains only the newest rows. number_after() prevents a wrap of this
  /// number.
  std::uint32_t rows_written;
  std::uint32_t rows_added;  ///< number of rows from the fault on
};

struct BlackBoxSlot {
  protocol::BlackBoxRow row;
  std::uint32_t check;
};

template <std::size_t before, std::size_t from_fault>
struct BlackBoxMemory {
  BlackBoxNotes notes;
  std::array<BlackBoxSlot, before> ring;
  std::array<BlackBoxSlot, from_fault> line;
};

/// Only the main loop uses the black box, because the control interrupt has no spare time. The main loop records every
/// twentieth sample and detects the fault. Rows can be missing if the main loop is late. The period numbers of the rows
/// show missing rows.
class BlackBox {
 public:
  /// The constructor does not read `memory`.
  template <std::size_t before, std::size_t from_fault>
  BlackBox(const SampleRing& samples, BlackBoxMemory<before, from_fault>& memory)
      : samples_(samples),
        notes_(memory.notes),
        ring_(memory.ring),
        line_(memory.line),
        followed_(samples.recorded()) {}

  /// Reads the rows of the previous run. Call this function once, before the control interrupt starts. `raised` is the
  /// fault that start-up raises, or `none`. `crash` is the crash record of the previous run.
  void start(protocol::Fault raised, const protocol::CrashFacts& crash);

  /// Records the samples since the last call. Call this function in every pass of the main loop.
  void follow();

  protocol::BlackBoxReport report() const;
  /// Selects the first row of rows() from a BlackBoxRequest. An invalid request changes only the request result in
  /// rows(). Bytes after the request are ignored.
  void select_rows(std::span<const std::byte> request);
  protocol::BlackBoxRowsReport rows() const;

 private:
  enum class Phase : std::uint8_t { recording, fault_seen, complete };

  void restart_recording();
  void start_fault_record(protocol::Fault fault, std::uint32_t period, bool is_restart,
                          const protocol::CrashFacts& crash);
  void record_sample(const Sample& sample);
  void add_after_fault(const Sample& sample);
  /// Returns the slot of a row before the fault. `number` counts rows since recording started.
  BlackBoxSlot& before(std::uint32_t number) const { return ring_[number % ring_.size()]; }
  std::uint32_t row_count() const { return rows_before_ + rows_from_fault_; }

  const SampleRing& samples_;
  BlackBoxNotes& notes_;
  std::span<BlackBoxSlot> ring_;  ///< rows before the fault
  std::span<BlackBoxSlot> line_;  ///< rows from the fault on
  Phase phase_ = Phase::recording;
  std::uint32_t tables_hash_ = 0;
  std::uint32_t followed_;  ///< number of samples read from the ring
  // Numbers of valid rows.
  std::uint32_t rows_before_ = 0;
  std::uint32_t rows_from_fault_ = 0;
  std::uint16_t first_row_ = 0;                                         ///< requested by the host
  protocol::RequestResult result_ = protocol::RequestResult::accepted;  ///< result of the host's last request
};

}  // namespace inkwell::link
