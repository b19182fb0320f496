#include "firmware/store/stored_parameters.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "firmware/store/parameter_check.hpp"

namespace inkwell::link {

using protocol::ParameterSet;
using protocol::StoreContents;
using protocol::StoreResult;

namespace {

/// In the force law report, the name of the force law follows the header.
std::uint32_t installed_force_law_hash() {
  const auto* name =
      reinterpret_cast<const char*>(control::installed_force_law.report) + sizeof(protocol::ForceLawReport);
  return protocol::force_law_name_hash(name);
}

bool differ(float one, float other) { return std::bit_cast<std::uint32_t>(one) != std::bit_cast<std::uint32_t>(other); }

bool are_equal(const ParameterSet& one, const ParameterSet& other) {
  for (std::size_t i = 0; i < image_parameter_count(); ++i)
    if (differ(one.values[i], other.values[i])) return false;
  return true;
}

bool belongs_to_a_law(std::uint32_t id) { return id >= protocol::force_law_first_id; }

/// Returns the index of a stored parameter in this image. A parameter of another force law has no index, even if its id
/// is known.
std::optional<std::size_t> known_index(std::uint32_t id, bool same_law) {
  if (id > 0xFFFF || (!same_law && belongs_to_a_law(id))) return std::nullopt;
  return image_parameter_index(static_cast<std::uint16_t>(id));
}

}  // namespace

StoredParameters::StoredParameters() : set_(image_defaults()), writing_(set_) {}

void StoredParameters::start(FlashMemory& memory, std::array<std::uint8_t, 3> version, ParameterStore& parameters) {
  for (std::size_t i = 0; i < version.size(); ++i) firmware_version_ |= std::uint32_t{version[i]} << 8 * i;
  log_.start(memory);
  has_flash_ = true;
  load(parameters);
}

void StoredParameters::load(ParameterStore& parameters) {
  const auto& record = log_.newest();
  if (!record) return;
  const RecordHead& head = record->head;
  for (std::size_t i = 0; i < 4; ++i)
    at_start_.firmware_version[i] = static_cast<std::uint8_t>(head.firmware_version >> 8 * i);
  at_start_.parameter_table_hash = head.parameter_table_hash;
  at_start_.force_law_hash = head.force_law_hash;
  at_start_.schema = head.schema;
  const auto kind = static_cast<RecordKind>(head.kind);
  contents_ = head.schema != protocol::store_schema ? StoreContents::other_schema
              : kind == RecordKind::factory_reset   ? StoreContents::factory_reset
              : kind == RecordKind::parameters      ? StoreContents::parameters
                                                    : StoreContents::other_schema;
  at_start_.contents_at_start = contents_;
  if (!has_parameters()) return;

  const bool same_law = head.force_law_hash == installed_force_law_hash();
  at_start_.entries = static_cast<std::uint16_t>(record->payload.size() / 2);
  StoredSet stored;
  for (std::size_t i = 0; i < at_start_.entries; ++i) {
    const std::uint32_t id = record->payload[2 * i];
    if (const auto index = known_index(id, same_law)) {
      stored.put(*index, std::bit_cast<float>(record->payload[2 * i + 1]));
      continue;
    }
    if (at_start_.unknown < protocol::store_unknown_ids_maximum)
      at_start_.unknown_ids[at_start_.unknown] = static_cast<std::uint16_t>(std::min<std::uint32_t>(id, 0xFFFF));
    ++at_start_.unknown;
  }
  stored.make_consistent();
  at_start_.out_of_range = stored.refused();
  set_.put(stored.set());
  is_as_written_here_ = stored.refused() == 0 && same_law &&
                        head.parameter_table_hash == protocol::parameter_table_hash &&
                        head.firmware_version == firmware_version_;
  parameters.start_with(stored.set());
}

void StoredParameters::ask(protocol::Command command, bool may) {
  ++commands_;
  if (!may) {
    result_ = StoreResult::force_is_on;
    return;
  }
  wanted_ = command == protocol::Command::store_parameters ? Wanted::store : Wanted::factory_reset;
  result_ = StoreResult::under_way;
}

void StoredParameters::follow(ParameterStore& parameters, bool force_is_on, std::uint32_t periods) {
  if (!is_busy() || force_is_on || periods - last_step_periods_ < periods_between_words) return;
  last_step_periods_ = periods;
  if (!(parameters.values_are_intact() && is_intact()))
    give_up();
  else if (is_writing_)
    write();
  else if (is_resetting_)
    is_resetting_ = !parameters.restore_defaults();
  else
    begin(parameters.guarded_values());
  if (!is_busy() && result_ == StoreResult::under_way) result_ = result_of_reset_;
}

// An incomplete record in flash is ignored. A factory reset in the flash takes effect at the next start.
void StoredParameters::give_up() {
  wanted_ = Wanted::nothing;
  is_writing_ = is_resetting_ = false;
  result_ = StoreResult::flash_failed;
}

void StoredParameters::begin(const Guarded<ParameterSet>& held) {
  const Wanted wanted = std::exchange(wanted_, Wanted::nothing);
  result_of_reset_ = StoreResult::done;
  result_ = StoreResult::under_way;
  if (wanted == Wanted::store) {
    if (has_parameters() && is_as_written_here_ && are_equal(held.value(), set_.value())) return;
    writing_ = held;
    return begin_record(RecordKind::parameters, put_entries(writing_.value()));
  }
  if (contents_ == StoreContents::nothing || contents_ == StoreContents::factory_reset) {
    result_of_reset_ = StoreResult::nothing_stored;
    is_resetting_ = true;
    return;
  }
  begin_record(RecordKind::factory_reset, 0);
}

void StoredParameters::begin_record(RecordKind kind, std::size_t entries) {
  kind_ = kind;
  is_writing_ = has_flash_ && log_.begin(head(kind), std::span(payload_.value()).first(2 * entries));
  if (!is_writing_) result_ = StoreResult::no_room;
}

RecordHead StoredParameters::head(RecordKind kind) const {
  return {.schema = protocol::store_schema,
          .kind = static_cast<std::uint16_t>(kind),
          .firmware_version = firmware_version_,
          .parameter_table_hash = protocol::parameter_table_hash,
          .force_law_hash = installed_force_law_hash()};
}

/// Writes the parameters of this image, followed by the unknown entries of the newest record. Entries of another force
/// law are omitted, because the ids of force laws overlap.
std::size_t StoredParameters::put_entries(const ParameterSet& held) {
  std::size_t count = 0;
  auto& payload = payload_.open();
  const auto put = [&](std::uint32_t id, std::uint32_t value) {
    payload[2 * count] = id;
    payload[2 * count + 1] = value;
    ++count;
  };
  for (std::size_t i = 0; i < image_parameter_count(); ++i)
    put(image_parameter_id(i), std::bit_cast<std::uint32_t>(held.values[i]));
  const auto& newest = log_.newest();
  const std::span<const std::uint32_t> old =
      newest && has_parameters() ? newest->payload : std::span<const std::uint32_t>{};
  for (std::size_t i = 0; i + 1 < old.size() && count < entries_maximum; i += 2)
    if (!belongs_to_a_law(old[i]) && !known_index(old[i], true)) put(old[i], old[i + 1]);
  payload_.seal();
  return count;
}

void StoredParameters::write() {
  const FlashLog::Progress progress = log_.step();
  if (progress == FlashLog::Progress::under_way) return;
  is_writing_ = false;
  if (progress == FlashLog::Progress::failed) {
    result_ = StoreResult::flash_failed;
    return;
  }
  is_as_written_here_ = true;
  if (kind_ == RecordKind::parameters) {
    contents_ = StoreContents::parameters;
    set_ = writing_;
    return;
  }
  contents_ = StoreContents::factory_reset;
  set_.put(image_defaults());
  is_resetting_ = true;
}

protocol::StoreReport StoredParameters::report(const ParameterSet& held) const {
  protocol::StoreReport report = at_start_;
  report.report_id = protocol::ReportId::store;
  report.result = result_;
  report.contents = contents_;
  for (std::size_t i = 0; i < image_parameter_count(); ++i)
    report.differing = static_cast<std::uint16_t>(report.differing + differ(held.values[i], next_start().values[i]));
  report.stores_left = static_cast<std::uint16_t>(log_.room(2 * (image_parameter_count() + at_start_.unknown)));
  report.commands = commands_;
  report.records_written = log_.records_written();
  for (std::size_t i = 0; i < protocol::store_sectors; ++i) report.sector_erases[i] = log_.erases()[i];
  return report;
}

std::size_t StoredParameters::read(protocol::ParametersReport& report) const {
  return read_set(next_start(), protocol::ReportId::stored, protocol::ParameterOperation::restore_stored, report);
}

}  // namespace inkwell::link
