// Tests stored parameters, including sets from other firmware versions.
#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <initializer_list>
#include <utility>
#include <vector>

#include "firmware/store/stored_parameters.hpp"

#include "tests/firmware/link/transaction.hpp"
#include "tests/firmware/store/plain_flash.hpp"

namespace inkwell {
namespace {

using link::FlashLog;
using link::RecordHead;
using link::RecordKind;
using protocol::Command;
using protocol::Parameter;
using protocol::StoreContents;
using protocol::StoreReport;
using protocol::StoreResult;
using test::PlainFlash;

constexpr std::array<std::uint8_t, 3> this_version{1, 2, 3};
constexpr Parameter force_limit = Parameter::force_limit_N, link_length = Parameter::link_2_m;

std::uint16_t id_of(Parameter parameter) { return protocol::info(parameter).id; }
float default_of(Parameter parameter) { return link::image_defaults()[parameter]; }

/// A board that starts with the contents of `flash`.
struct Board {
  link::ParameterStore parameters;
  link::StoredParameters stored;
  std::uint32_t periods = 0xFFFF'FF00;  // wraps soon

  explicit Board(PlainFlash& flash, std::array<std::uint8_t, 3> version = this_version) {
    stored.start(flash, version, parameters);
  }
  void set(Parameter parameter, float value) {
    REQUIRE(parameters.accept(test::Transaction{test::entry(parameter, value)}.bytes(), false) ==
            protocol::Refusal::accepted);
    parameters.apply_offered(periods);
  }
  void step(bool force_is_on = false) {
    periods += 10;
    stored.follow(parameters, force_is_on, periods);
    parameters.apply_offered(periods);
  }
  StoreResult finish() {
    for (int i = 0; i < 2000 && stored.is_busy(); ++i) step();
    CHECK_FALSE(stored.is_busy());
    return report().result;
  }
  StoreResult run(Command command) {
    stored.ask(command, true);
    return finish();
  }
  StoreResult store() { return run(Command::store_parameters); }
  StoreResult forget() { return run(Command::factory_reset); }
  StoreReport report() const { return stored.report(parameters.values()); }
  float held(Parameter parameter) const { return parameters.values()[parameter]; }
};

/// Stores one value with a temporary board.
void store_in(PlainFlash& flash, Parameter parameter, float value) {
  Board board(flash);
  board.set(parameter, value);
  REQUIRE(board.store() == StoreResult::done);
}

using Entries = std::vector<std::pair<std::uint32_t, float>>;

FlashLog log_of(PlainFlash& flash) {
  FlashLog log;
  log.start(flash);
  return log;
}

/// Writes a record of any firmware version.
void write(PlainFlash& flash, RecordHead head, const Entries& entries) {
  std::vector<std::uint32_t> payload;
  for (const auto& [id, value] : entries) {
    payload.push_back(id);
    payload.push_back(std::bit_cast<std::uint32_t>(value));
  }
  FlashLog log = log_of(flash);
  REQUIRE(log.begin(head, payload));
  while (log.step() == FlashLog::Progress::under_way) {
  }
}

/// Returns the header of a record of this firmware.
RecordHead valid_head() {
  PlainFlash flash;
  store_in(flash, force_limit, 1.0f);
  return log_of(flash).newest()->head;
}

Entries entries_of(PlainFlash& flash) {
  Entries entries;
  const FlashLog log = log_of(flash);
  const auto payload = log.newest()->payload;
  for (std::size_t i = 0; i + 1 < payload.size(); i += 2)
    entries.emplace_back(payload[i], std::bit_cast<float>(payload[i + 1]));
  return entries;
}

bool holds(const Entries& entries, std::uint32_t id, float value) {
  for (const auto& entry : entries)
    if (entry == std::pair{id, value}) return true;
  return false;
}

}  // namespace

TEST_CASE("stored parameters: a blank flash provides the defaults, and the report shows this") {
  PlainFlash flash;
  const Board board(flash);
  CHECK(board.parameters.values() == link::image_defaults());
  CHECK(board.stored.next_start() == link::image_defaults());
  CHECK_FALSE(board.stored.has_parameters());
  const StoreReport report = board.report();
  CHECK(report.report_id == protocol::ReportId::store);
  CHECK(report.result == StoreResult::none);
  CHECK(report.contents == StoreContents::nothing);
  CHECK(report.contents_at_start == StoreContents::nothing);
  CHECK(report.schema == 0);
  CHECK(report.entries == 0);
  CHECK(report.commands == 0);
  CHECK(report.records_written == 0);
  CHECK(report.differing == 0);
  CHECK(report.stores_left > 10);
}

TEST_CASE("stored parameters: the next start has the values that were set when the store command arrived") {
  PlainFlash flash;
  Board board(flash);
  board.set(force_limit, 1.25f);
  CHECK(board.report().differing == 1);
  board.stored.ask(Command::store_parameters, true);
  CHECK(board.report().result == StoreResult::under_way);
  board.step();
  CHECK(board.report().contents == StoreContents::nothing);  // the record counts only after its last word
  CHECK(board.report().differing == 1);
  CHECK(board.finish() == StoreResult::done);
  const std::uint16_t left = board.report().stores_left;
  CHECK(board.report().differing == 0);
  CHECK(board.report().contents == StoreContents::parameters);
  CHECK(board.report().contents_at_start == StoreContents::nothing);
  CHECK(board.report().records_written == 1);
  CHECK(board.report().commands == 1);

  const Board next(flash);
  CHECK(next.held(force_limit) == 1.25f);
  CHECK(next.parameters.settings_are_intact());
  CHECK(next.stored.next_start()[force_limit] == 1.25f);
  const StoreReport report = next.report();
  CHECK(report.result == StoreResult::none);
  CHECK(report.contents == StoreContents::parameters);
  CHECK(report.contents_at_start == StoreContents::parameters);
  CHECK(report.entries == link::image_parameter_count());
  CHECK(report.unknown == 0);
  CHECK(report.out_of_range == 0);
  CHECK(report.schema == protocol::store_schema);
  CHECK(report.parameter_table_hash == protocol::parameter_table_hash);
  CHECK(report.firmware_version[0] == 1);
  CHECK(report.firmware_version[1] == 2);
  CHECK(report.firmware_version[2] == 3);
  CHECK(report.firmware_version[3] == 0);
  CHECK(report.stores_left == left);
  CHECK(report.commands == 0);
}

TEST_CASE("stored parameters: the set stays as it was when the writing began") {
  PlainFlash flash;
  Board board(flash);
  board.set(force_limit, 1.25f);
  board.stored.ask(Command::store_parameters, true);
  board.step();
  board.set(force_limit, 2.0f);
  CHECK(board.finish() == StoreResult::done);
  CHECK(board.held(force_limit) == 2.0f);
  CHECK(board.report().differing == 1);
  CHECK(Board(flash).held(force_limit) == 1.25f);
}

TEST_CASE("stored parameters: refused while it may not be, and nothing is written") {
  PlainFlash flash;
  Board board(flash);
  const unsigned words = flash.words_programmed;
  for (const Command command : {Command::store_parameters, Command::factory_reset}) {
    board.set(force_limit, 1.25f);
    board.stored.ask(command, false);
    CHECK_FALSE(board.stored.is_busy());
    CHECK(board.report().result == StoreResult::force_is_on);
    for (int i = 0; i < 100; ++i) board.step();
    CHECK(flash.words_programmed == words);
    CHECK(board.held(force_limit) == 1.25f);
  }
  CHECK(board.report().commands == 2);
}

TEST_CASE("stored parameters: a word every ten control periods, and none while the force is on") {
  PlainFlash flash;
  Board board(flash);
  board.set(force_limit, 1.25f);
  board.stored.ask(Command::store_parameters, true);
  board.step();  // starts the record
  board.step();
  const unsigned words = flash.words_programmed;
  for (int i = 0; i < 9; ++i) board.stored.follow(board.parameters, false, ++board.periods);
  CHECK(flash.words_programmed == words);
  board.stored.follow(board.parameters, false, ++board.periods);
  CHECK(flash.words_programmed == words + 1);
  for (int i = 0; i < 100; ++i) board.step(true);
  CHECK(flash.words_programmed == words + 1);
  CHECK(board.report().result == StoreResult::under_way);
  CHECK(board.stored.is_busy());
  board.step();
  CHECK(flash.words_programmed == words + 2);
  CHECK(board.finish() == StoreResult::done);
}

TEST_CASE("stored parameters: values that are already stored are not written again") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  const unsigned words = flash.words_programmed;
  CHECK(board.store() == StoreResult::done);
  CHECK(flash.words_programmed == words);
  board.set(force_limit, 1.5f);
  CHECK(board.store() == StoreResult::done);
  CHECK(flash.words_programmed > words);
  const unsigned more = flash.words_programmed;
  CHECK(board.store() == StoreResult::done);
  CHECK(flash.words_programmed == more);
  CHECK(board.report().commands == 3);
  // A newer firmware replaces the record of the previous firmware.
  Board newer(flash, {1, 2, 4});
  CHECK(newer.held(force_limit) == 1.5f);
  CHECK(newer.store() == StoreResult::done);
  CHECK(flash.words_programmed > more);
  CHECK(Board(flash).report().firmware_version[2] == 4);
}

TEST_CASE("stored parameters: zero and minus zero are two values") {
  PlainFlash flash;
  RecordHead head = valid_head();
  write(flash, head, {{id_of(Parameter::box_minimum_x_m), -0.0f}});
  Board board(flash);
  board.set(Parameter::box_minimum_x_m, 0.0f);
  CHECK(board.report().differing == 1);
}

TEST_CASE("stored parameters: a factory reset restores the defaults immediately and for the next start") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  board.set(link_length, 0.15f);
  CHECK(board.forget() == StoreResult::done);
  CHECK(board.parameters.values() == link::image_defaults());
  CHECK(board.stored.next_start() == link::image_defaults());
  CHECK(board.report().contents == StoreContents::factory_reset);
  CHECK(board.report().contents_at_start == StoreContents::parameters);
  CHECK_FALSE(board.stored.has_parameters());

  Board next(flash);
  CHECK(next.parameters.values() == link::image_defaults());
  CHECK(next.report().contents_at_start == StoreContents::factory_reset);
  CHECK(next.report().entries == 0);
  next.set(force_limit, 2.0f);
  const unsigned words = flash.words_programmed;
  CHECK(next.forget() == StoreResult::nothing_stored);
  CHECK(next.held(force_limit) == default_of(force_limit));
  CHECK(flash.words_programmed == words);
  next.set(force_limit, 2.0f);
  CHECK(next.store() == StoreResult::done);  // storing works again
  CHECK(Board(flash).held(force_limit) == 2.0f);
}

TEST_CASE(
    "stored parameters: a factory reset without stored parameters restores the defaults after the previous "
    "transaction") {
  PlainFlash flash;
  Board board(flash);
  REQUIRE(board.parameters.accept(test::Transaction{test::entry(force_limit, 2.0f)}.bytes(), false) ==
          protocol::Refusal::accepted);
  board.stored.ask(Command::factory_reset, true);
  for (int i = 0; i < 5; ++i) {
    board.periods += 10;
    board.stored.follow(board.parameters, false, board.periods);
    CHECK(board.report().result == StoreResult::under_way);
    CHECK(board.held(force_limit) == 2.0f);
  }
  board.parameters.apply_offered(board.periods);
  CHECK(board.finish() == StoreResult::nothing_stored);
  CHECK(board.parameters.values() == link::image_defaults());
}

TEST_CASE("stored parameters: parameters of another firmware are counted as unknown and retained") {
  PlainFlash flash;
  RecordHead head = valid_head();
  head.firmware_version = 0x0009'0807;
  head.parameter_table_hash = 0x1234;
  write(flash, head, {{id_of(force_limit), 1.25f}, {7, 5.0f}, {70'000, 6.0f /* no id of any firmware */}, {999, 7.0f}});
  Board board(flash);
  CHECK(board.held(force_limit) == 1.25f);
  const StoreReport report = board.report();
  CHECK(report.entries == 4);
  CHECK(report.unknown == 3);
  CHECK(report.unknown_ids[0] == 7);
  CHECK(report.unknown_ids[1] == 0xFFFF);
  CHECK(report.unknown_ids[2] == 999);
  CHECK(report.unknown_ids[3] == 0);
  CHECK(report.firmware_version[0] == 7);
  CHECK(report.firmware_version[1] == 8);
  CHECK(report.firmware_version[2] == 9);
  CHECK(report.parameter_table_hash == 0x1234);

  CHECK(board.store() == StoreResult::done);  // no value differs, but the record of another firmware is replaced
  const Entries entries = entries_of(flash);
  CHECK(entries.size() == link::image_parameter_count() + 2);
  CHECK(holds(entries, id_of(force_limit), 1.25f));
  CHECK(holds(entries, 7, 5.0f));
  CHECK(holds(entries, 999, 7.0f));
  CHECK(board.forget() == StoreResult::done);
  CHECK(board.store() == StoreResult::done);
  CHECK(entries_of(flash).size() == link::image_parameter_count());
}

TEST_CASE("stored parameters: unknown parameters are retained up to the available size") {
  PlainFlash flash;
  Entries many;
  for (std::uint32_t i = 0; i < 200; ++i) many.emplace_back(2 + i % 90, 1.0f);
  write(flash, valid_head(), many);
  Board board(flash);
  CHECK(board.report().unknown == 200);
  for (const std::uint16_t id : board.report().unknown_ids) CHECK(id >= 2);
  board.set(force_limit, 1.5f);
  CHECK(board.store() == StoreResult::done);
  CHECK(entries_of(flash).size() == protocol::parameter_entries_maximum + 32);
  CHECK(Board(flash).held(force_limit) == 1.5f);
}

TEST_CASE("stored parameters: the parameters of another force law are neither used nor retained") {
  PlainFlash flash;
  RecordHead head = valid_head();
  head.force_law_hash ^= 1;
  write(flash, head, {{id_of(force_limit), 1.25f}, {protocol::force_law_first_id, 3.0f}});
  Board board(flash);
  CHECK(board.report().unknown == 1);
  CHECK(board.report().unknown_ids[0] == protocol::force_law_first_id);
  CHECK(board.report().force_law_hash == head.force_law_hash);
  const unsigned words = flash.words_programmed;
  CHECK(board.store() == StoreResult::done);
  CHECK(flash.words_programmed > words);
  CHECK(entries_of(flash).size() == link::image_parameter_count());
}

TEST_CASE(
    "stored parameters: a value that this firmware refuses becomes the default, and a pair that contradicts too") {
  PlainFlash flash;
  write(flash, valid_head(),
        {{id_of(force_limit), 1e9f},
         {id_of(link_length), 0.15f},
         {id_of(Parameter::box_minimum_x_m), 0.05f},
         {id_of(Parameter::box_maximum_x_m), 0.05f}});
  Board board(flash);
  CHECK(board.held(force_limit) == default_of(force_limit));
  CHECK(board.held(link_length) == 0.15f);
  CHECK(board.held(Parameter::box_minimum_x_m) == default_of(Parameter::box_minimum_x_m));
  CHECK(board.held(Parameter::box_maximum_x_m) == default_of(Parameter::box_maximum_x_m));
  CHECK(board.report().out_of_range == 3);
  CHECK(board.report().unknown == 0);
  const unsigned words = flash.words_programmed;
  CHECK(board.store() == StoreResult::done);  // replaces the record with the invalid values
  CHECK(flash.words_programmed > words);
  CHECK(Board(flash).report().out_of_range == 0);
}

TEST_CASE("stored parameters: a record with another schema or kind is reported, and the defaults apply") {
  for (const bool other_schema : {true, false}) {
    PlainFlash flash;
    RecordHead head = valid_head();
    if (other_schema)
      head.schema = protocol::store_schema + 1;
    else
      head.kind = 9;
    write(flash, head, {{id_of(force_limit), 1.25f}});
    Board board(flash);
    CHECK(board.held(force_limit) == default_of(force_limit));
    CHECK(board.report().contents == StoreContents::other_schema);
    CHECK(board.report().contents_at_start == StoreContents::other_schema);
    CHECK(board.report().entries == 0);
    CHECK(board.report().schema == head.schema);
    CHECK(board.forget() == StoreResult::done);
    CHECK(Board(flash).report().contents == StoreContents::factory_reset);
  }
}

TEST_CASE("stored parameters: where there is no room nothing changes, and the next start makes some") {
  PlainFlash flash;
  Board board(flash);
  float value = 0.5f;
  std::uint16_t left = board.report().stores_left;
  while (left > 0) {
    board.set(force_limit, value += 0.001f);
    REQUIRE(board.store() == StoreResult::done);
    CHECK(board.report().stores_left == left - 1);
    left = board.report().stores_left;
  }
  const float last = value;
  board.set(force_limit, 2.0f);
  CHECK(board.store() == StoreResult::no_room);
  CHECK(board.report().differing == 1);
  Board next(flash);
  CHECK(next.held(force_limit) == last);
  CHECK(next.report().sector_erases[0] + next.report().sector_erases[1] == 1);
  next.set(force_limit, 2.0f);
  CHECK(next.store() == StoreResult::done);
  CHECK(Board(flash).held(force_limit) == 2.0f);
}

TEST_CASE("stored parameters: a worn flash is reported, and the last stored values remain valid") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  board.set(force_limit, 2.0f);
  flash.is_worn = true;
  CHECK(board.store() == StoreResult::flash_failed);
  CHECK(board.forget() == StoreResult::flash_failed);
  CHECK(board.held(force_limit) == 2.0f);
  CHECK(board.report().contents == StoreContents::parameters);
  CHECK(board.report().differing == 1);
  CHECK(board.stored.next_start()[force_limit] == 1.25f);
  flash.is_worn = false;
  CHECK(Board(flash).held(force_limit) == 1.25f);
}

TEST_CASE("stored parameters: a host can send the report of the stored values back to restore them") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  board.set(force_limit, 2.0f);
  protocol::ParametersReport report = test::spoiled_report();
  CHECK(board.stored.read(report) == protocol::parameters_report_size(link::image_parameter_count()));
  CHECK(report.report_id == protocol::ReportId::stored);
  CHECK(report.operation == protocol::ParameterOperation::restore_stored);
  CHECK(report.version == protocol::protocol_version);
  CHECK(report.count == link::image_parameter_count());
  CHECK(report.ticket == 0);
  CHECK(report.claim == 0);
  bool found = false;
  for (std::size_t i = 0; i < report.count; ++i)
    if (report.entries[i].id == id_of(force_limit)) found = report.entries[i].value == 1.25f;
  CHECK(found);
}

TEST_CASE("stored parameters: values of which a bit has changed are not stored, nor replaced by the defaults") {
  for (const Command command : {Command::store_parameters, Command::factory_reset}) {
    PlainFlash flash;
    store_in(flash, force_limit, 1.25f);
    Board board(flash);
    board.set(link_length, 0.15f);
    test::flip_bit(board.parameters.values().values[static_cast<std::size_t>(force_limit)]);
    const unsigned words = flash.words_programmed;
    CHECK(board.run(command) == StoreResult::flash_failed);
    CHECK(flash.words_programmed == words);
    CHECK_FALSE(board.parameters.values_are_intact());
    CHECK(Board(flash).held(force_limit) == 1.25f);
  }
}

TEST_CASE("stored parameters: a bit flip during a write leaves the previous record valid") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  board.set(force_limit, 1.5f);
  board.stored.ask(Command::store_parameters, true);
  for (int i = 0; i < 5; ++i) board.step();
  test::flip_bit(board.parameters.values().values[0]);
  CHECK(board.finish() == StoreResult::flash_failed);
  CHECK(Board(flash).held(force_limit) == 1.25f);
  test::flip_bit(board.parameters.values().values[0]);
  CHECK(board.store() == StoreResult::done);
  CHECK(Board(flash).held(force_limit) == 1.5f);
}

TEST_CASE("stored parameters: a bit flip in any word of the written or the stored values is detected") {
  PlainFlash flash;
  Board board(flash);
  board.set(force_limit, 1.2345f);
  REQUIRE(board.store() == StoreResult::done);
  CHECK(board.stored.is_intact());
  // The test searches the private members for the unique value of the force limit.
  auto* const bytes = reinterpret_cast<std::byte*>(&board.stored);
  unsigned copies = 0;
  for (std::size_t at = 0; at < sizeof board.stored; at += sizeof(float)) {
    float value;
    std::memcpy(&value, bytes + at, sizeof value);
    if (value != 1.2345f) continue;
    ++copies;
    bytes[at] ^= std::byte{0x10};
    CHECK_FALSE(board.stored.is_intact());
    CHECK(board.store() == StoreResult::flash_failed);
    bytes[at] ^= std::byte{0x10};
  }
  CHECK(copies == 3);  // the set for the next start, the written set, and the words in the flash
  CHECK(board.stored.is_intact());
}

TEST_CASE("stored parameters: a factory reset that meets a damaged value ends, and the next start carries it out") {
  PlainFlash flash;
  store_in(flash, force_limit, 1.25f);
  Board board(flash);
  board.stored.ask(Command::factory_reset, true);
  while (board.report().contents == StoreContents::parameters) board.step();
  CHECK(board.stored.is_busy());
  test::flip_bit(board.parameters.values().values[static_cast<std::size_t>(force_limit)]);
  CHECK(board.finish() == StoreResult::flash_failed);
  CHECK_FALSE(board.parameters.values_are_intact());
  CHECK(Board(flash).held(force_limit) == default_of(force_limit));
}

TEST_CASE("stored parameters: restorable returns the parameters of the next start after a store") {
  PlainFlash flash;
  Board board(flash);
  CHECK(board.stored.restorable() == nullptr);
  board.set(force_limit, 1.25f);
  CHECK(board.store() == StoreResult::done);
  REQUIRE(board.stored.restorable() != nullptr);
  CHECK(&board.stored.restorable()->value() == &board.stored.next_start());
  CHECK(board.stored.restorable()->is_intact());
}

TEST_CASE("stored parameters: without a flash nothing can be stored") {
  link::ParameterStore parameters;
  link::StoredParameters stored;
  stored.ask(Command::store_parameters, true);
  stored.follow(parameters, false, 1000);
  CHECK_FALSE(stored.is_busy());
  CHECK(stored.report(parameters.values()).result == StoreResult::no_room);
  CHECK(stored.report(parameters.values()).stores_left == 0);
}

}  // namespace inkwell
