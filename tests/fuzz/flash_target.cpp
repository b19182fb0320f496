// Fuzz target for the flash content of the parameter store. An earlier firmware, an interrupted write or a worn chip
// can leave any content in the flash.
#include <cstring>
#include <stdexcept>

#include "firmware/store/stored_parameters.hpp"

#include "tests/firmware/store/plain_flash.hpp"
#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {
namespace {

constexpr std::array<std::uint8_t, 3> version{1, 0, 0};
constexpr std::size_t sector_words = 600;  // small, because erased words would take most of the time

/// Fills the first bytes of both sectors with the raw input.
void fill(test::PlainFlash& flash, Input input) {
  const std::size_t half = input.size() / 2;
  std::memcpy(flash.sectors[0].data(), input.data(), std::min(half, 4 * sector_words));
  std::memcpy(flash.sectors[1].data(), input.data() + half, std::min(input.size() - half, 4 * sector_words));
}

/// Writes a complete record with any header and payload.
void write_record(test::PlainFlash& flash, Input input) {
  link::RecordHead head{};
  if (input.size() < sizeof head) return;
  std::memcpy(&head, input.data(), sizeof head);
  input = input.subspan(sizeof head);
  std::vector<std::uint32_t> payload(input.size() / 4);
  if (!payload.empty()) std::memcpy(payload.data(), input.data(), 4 * payload.size());
  link::FlashLog log;
  log.start(flash);
  if (!log.begin(head, payload)) return;
  while (log.step() == link::FlashLog::Progress::under_way) {
  }
}

/// With any flash content, the board starts with a valid parameter set, stores this set and starts with it again.
void start(Input input) {
  if (input.empty()) return;
  test::PlainFlash flash(sector_words);
  const bool is_record = std::to_integer<unsigned>(input[0]) % 2 != 0;
  is_record ? write_record(flash, input.subspan(1)) : fill(flash, input.subspan(1));

  link::ParameterStore parameters;
  link::StoredParameters stored;
  stored.start(flash, version, parameters);
  stored.report(parameters.values());
  protocol::ParametersReport report;
  const std::size_t size = parameters.read(report);
  const auto bytes = std::as_bytes(std::span(&report, 1)).first(size);
  if (link::check_transaction(bytes, link::image_defaults(), false).refusal != protocol::Refusal::accepted)
    throw std::logic_error("the start took parameters that the board refuses");

  stored.ask(protocol::Command::store_parameters, true);
  for (std::uint32_t periods = 1000; stored.is_busy(); periods += 10) {
    if (periods > 1'000'000) throw std::logic_error("the store does not end");
    stored.follow(parameters, false, periods);
  }
  if (stored.report(parameters.values()).result != protocol::StoreResult::done) return;
  link::ParameterStore next_parameters;
  link::StoredParameters next;
  next.start(flash, version, next_parameters);
  if (next_parameters.values() != parameters.values())
    throw std::logic_error("the next start does not hold what was stored");
}

std::vector<Bytes> examples() {
  link::RecordHead head{.magic = 0,
                        .schema = protocol::store_schema,
                        .kind = static_cast<std::uint16_t>(link::RecordKind::parameters),
                        .number = 0,
                        .payload = 0,
                        .firmware_version = 1,
                        .parameter_table_hash = protocol::parameter_table_hash,
                        .force_law_hash = 0};
  Bytes record{std::byte{1}};
  const auto append = [&](const auto& part) {
    const auto more = std::as_bytes(std::span(&part, 1));
    record.insert(record.end(), more.begin(), more.end());
  };
  append(head);
  for (std::size_t i = 0; i < link::image_parameter_count(); ++i) {
    append(std::uint32_t{link::image_parameter_id(i)});
    append(link::image_defaults().values[i]);
  }

  test::PlainFlash flash(sector_words);
  link::ParameterStore parameters;
  link::StoredParameters stored;
  stored.start(flash, version, parameters);
  stored.ask(protocol::Command::store_parameters, true);
  for (std::uint32_t periods = 1000; stored.is_busy(); periods += 10) stored.follow(parameters, false, periods);
  Bytes raw{std::byte{0}};
  for (const auto& sector : flash.sectors) {
    const auto words = std::as_bytes(std::span(sector).first(250));
    raw.insert(raw.end(), words.begin(), words.end());
  }
  return {record, raw};
}

const Registered parameter_flash{"parameter_flash", start, examples};

}  // namespace
}  // namespace inkwell::fuzz
