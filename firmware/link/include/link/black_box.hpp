// The black box: every signal of the last 100 ms before a fault and the first 100 ms after it, kept over a reset.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <link/sample_ring.hpp>
#include <protocol/black_box.hpp>

namespace inkwell::link {

/// What the black box remembers over a reset. It lies in memory that start-up does not clear and that holds anything
/// after power-up, so nothing in here is believed before its check has been looked at.
struct BlackBoxNotes {
  struct Cause {
    std::uint32_t fault;  ///< protocol::Fault
    std::uint32_t period;
    std::uint32_t is_restart;
    std::uint32_t later_crashes;
    protocol::CrashFacts crash;
    std::uint32_t check;
  };
  std::uint32_t tables_hash;   ///< of the tables that the rows are made by; another value: nothing in here counts
  Cause cause;                 ///< a black box is kept, if its check is right
  std::uint32_t rows_written;  ///< before the fault; only as many as have room are there. Falls before it wraps
  std::uint32_t rows_added;    ///< from the fault on
};

struct BlackBoxPlace {
  protocol::BlackBoxRow row;
  std::uint32_t check;
};

template <std::size_t before, std::size_t from_fault>
struct BlackBoxMemory {
  BlackBoxNotes notes;
  std::array<BlackBoxPlace, before> ring;
  std::array<BlackBoxPlace, from_fault> line;
};

/// Of no use in the control interrupt: the main loop follows the ring of samples and takes one in twenty, and so also
/// finds the fault, with its period. What it is too late for is missing, as the rows' periods tell.
class BlackBox {
 public:
  /// Looks at nothing in `memory` before start().
  template <std::size_t before, std::size_t from_fault>
  BlackBox(const SampleRing& samples, BlackBoxMemory<before, from_fault>& memory)
      : samples_(samples),
        notes_(memory.notes),
        ring_(memory.ring),
        line_(memory.line),
        followed_(samples.recorded()) {}

  /// Once, before the control interrupt runs: finds what the run before this one has left. `raised` is the fault that
  /// this start is going to raise because of how that run ended, or none; `crash` what the processor noted then.
  void start(protocol::Fault raised, const protocol::CrashFacts& crash);

  /// Takes what has been recorded since the last call. Call it every time that the main loop comes round.
  void follow();

  protocol::BlackBoxReport report() const;
  /// Chooses the first row of the next rows() by a BlackBoxRequest. A request that is not valid changes nothing but the
  /// result in rows(); the bytes after it are ignored.
  void select_rows(std::span<const std::byte> request);
  protocol::BlackBoxRowsReport rows() const;

 private:
  enum class Phase : std::uint8_t { recording, fault_seen, complete };

  void begin_anew();
  void keep(protocol::Fault fault, std::uint32_t period, bool is_restart, const protocol::CrashFacts& crash);
  void take(const Sample& sample);
  void add_after_fault(const Sample& sample);
  /// Where a row before the fault lies, by its number since recording began.
  BlackBoxPlace& before(std::uint32_t number) const { return ring_[number % ring_.size()]; }
  std::uint32_t row_count() const { return rows_before_ + rows_from_fault_; }

  const SampleRing& samples_;
  BlackBoxNotes& notes_;
  std::span<BlackBoxPlace> ring_;  ///< before the fault
  std::span<BlackBoxPlace> line_;  ///< from the fault on
  Phase phase_ = Phase::recording;
  std::uint32_t tables_hash_ = 0;
  std::uint32_t followed_;  ///< samples of the ring
  // While a black box is kept: how many of its rows are sound.
  std::uint32_t rows_before_ = 0;
  std::uint32_t rows_from_fault_ = 0;
  std::uint16_t first_row_ = 0;                                         ///< wanted by the host
  protocol::RequestResult result_ = protocol::RequestResult::accepted;  ///< of its last request
};

}  // namespace inkwell::link
