// Stored parameters. The firmware reads the stored parameters before the control interrupt starts. A command writes the
// parameters while the force is off, one word per pass of the main loop.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "firmware/store/flash_log.hpp"
#include "firmware/store/parameter_store.hpp"
#include "protocol/store.hpp"

namespace inkwell::link {

class StoredParameters {
 public:
  StoredParameters();

  /// Reads the flash, erases a sector if necessary, and sets `parameters` to the stored values. Call this function
  /// before the control interrupt starts. Without this call no parameters can be stored.
  void start(FlashMemory& memory, std::array<std::uint8_t, 3> firmware_version, ParameterStore& parameters);

  // ---- main loop ----

  /// Requests store_parameters or factory_reset. `may` is true if the command is allowed.
  void ask(protocol::Command command, bool may);
  /// Executes one step of the requested command. If a bit of the command's data has flipped, the command fails with
  /// flash_failed.
  ///
  /// A step may block the main loop while the flash programs one word. Writes are spread over time, so that poses are
  /// not delayed.
  void follow(ParameterStore& parameters, bool force_is_on, std::uint32_t periods);
  /// Returns true while a requested command is not finished.
  bool is_busy() const { return wanted_ != Wanted::nothing || is_writing_ || is_resetting_; }

  /// Returns the parameter values after the next start.
  const protocol::ParameterSet& next_start() const { return set_.value(); }
  /// Returns the parameter set for restore_stored, or null.
  const Guarded<protocol::ParameterSet>* restorable() const { return has_parameters() ? &set_ : nullptr; }
  /// Returns true if no bit of the stored data has flipped.
  bool is_intact() const { return set_.is_intact() && writing_.is_intact() && payload_.is_intact(); }
  bool has_parameters() const { return contents_ == protocol::StoreContents::parameters; }
  protocol::StoreReport report(const protocol::ParameterSet& held) const;
  /// Writes next_start() to a ParametersReport. Returns the number of used bytes.
  std::size_t read(protocol::ParametersReport& report) const;

 private:
  static constexpr std::uint32_t periods_between_words = 10;

  enum class Wanted : std::uint8_t { nothing, store, factory_reset };
  /// Largest number of entries in a record, including parameters of other firmware versions.
  static constexpr std::size_t entries_maximum = protocol::parameter_entries_maximum + 32;

  void load(ParameterStore& parameters);
  void give_up();
  void begin(const Guarded<protocol::ParameterSet>& held);
  void begin_record(RecordKind kind, std::size_t entries);
  void write();
  std::size_t put_entries(const protocol::ParameterSet& held);
  RecordHead head(RecordKind kind) const;

  Guarded<protocol::ParameterSet> set_;
  FlashLog log_;
  bool has_flash_ = false;
  protocol::StoreContents contents_ = protocol::StoreContents::nothing;
  bool is_as_written_here_ = false;  ///< true if the newest record is identical to a record of `set_` by this firmware
  protocol::StoreReport at_start_{};
  std::uint32_t firmware_version_ = 0;

  Wanted wanted_ = Wanted::nothing;
  bool is_writing_ = false, is_resetting_ = false;
  protocol::StoreResult result_ = protocol::StoreResult::none;
  protocol::StoreResult result_of_reset_ = protocol::StoreResult::done;
  std::uint32_t commands_ = 0;
  std::uint32_t last_step_periods_ = 0;
  RecordKind kind_ = RecordKind::parameters;
  Guarded<protocol::ParameterSet> writing_;
  Guarded<std::array<std::uint32_t, 2 * entries_maximum>> payload_{{}};
};

}  // namespace inkwell::link
