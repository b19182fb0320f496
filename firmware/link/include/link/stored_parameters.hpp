// What of the parameters outlives a start: read before the control interrupt runs, written on command, a word each time
// that the main loop comes round, and never while the force is on.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <link/flash_log.hpp>
#include <link/parameter_store.hpp>
#include <protocol/store.hpp>

namespace inkwell::link {

class StoredParameters {
 public:
  StoredParameters();

  /// Reads the flash, erases in it if it has to, and lets `parameters` hold what is stored. Before the control
  /// interrupt runs. Without it nothing can be stored.
  void start(FlashMemory& memory, std::array<std::uint8_t, 3> firmware_version, ParameterStore& parameters);

  // ---- main loop ----

  /// store_parameters or factory_reset has come; `may` is whether it may be carried out.
  void ask(protocol::Command command, bool may);
  /// One step of what was asked for, now and then; given up as flash_failed where a bit of what it goes by has changed
  /// by itself, which the background watch tells. It may hold up the main loop for as long as the flash takes for a
  /// word; `periods` are control periods, by which words keep their distance, so that poses stay in time.
  void follow(ParameterStore& parameters, bool force_is_on, std::uint32_t periods);
  /// Something that was asked for is not over.
  bool is_busy() const { return wanted_ != Wanted::nothing || is_writing_ || is_resetting_; }

  /// What the next start would give every parameter.
  const protocol::ParameterSet& next_start() const { return set_.value(); }
  /// What restore_stored gives; null is nothing.
  const Guarded<protocol::ParameterSet>* restorable() const { return has_parameters() ? &set_ : nullptr; }
  /// Whether what it holds, and writes, is bit for bit what it was given.
  bool is_intact() const { return set_.is_intact() && writing_.is_intact() && payload_.is_intact(); }
  bool has_parameters() const { return contents_ == protocol::StoreContents::parameters; }
  protocol::StoreReport report(const protocol::ParameterSet& held) const;
  /// As the ParametersReport of next_start(); returns the bytes that are used.
  std::size_t read(protocol::ParametersReport& report) const;

 private:
  static constexpr std::uint32_t periods_between_words = 10;

  enum class Wanted : std::uint8_t { nothing, store, factory_reset };
  /// Of a record: the parameters of this image, and some that another firmware has left.
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
  bool is_as_written_here_ = false;  ///< the newest record has just what this firmware would write for `set_`
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
