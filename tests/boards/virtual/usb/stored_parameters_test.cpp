// The flashed firmware stores its parameters in the flash of the virtual chip. The stored parameters survive a power
// loss at any word. Storing does not delay the control interrupt or the poses, and the watchdog does not expire.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "boards/stm32f405/core/memory_map.hpp"
#include "firmware/store/flash_log.hpp"
#include "protocol/store.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using protocol::Command;
using protocol::Parameter;
using protocol::ReportId;
using protocol::StoreContents;
using protocol::StoreResult;
using virtual_board::ChipOptions;
using virtual_board::ResetCause;

constexpr float default_stiffness = 800.0f;

struct StoringBoard {
  explicit StoringBoard(const ChipOptions& options = {}) : bus(flashed_image(), 0.0, options) {
    bus.chip.on_reset = [this](ResetCause cause) {
      if (cause == ResetCause::power_on) trial_is_due = true;
      if (cause == ResetCause::independent_watchdog) resets += std::exchange(trial_is_due, false) ? 0 : 1;
    };
  }

  void start() {
    bus.connect();
    bus.run_for(0.35);  // the self-test after start-up
  }
  void switch_off_and_on() {
    bus.plug(false);
    bus.chip.reset(ResetCause::power_on);
    bus.run_for(0.01);
    bus.plug(true);
    start();
  }
  template <class Report>
  Report get(ReportId id) {
    Report report{};
    const auto answer =
        bus.control(0xA1, 1, static_cast<std::uint16_t>(0x0300 | static_cast<int>(id)), 0, sizeof report);
    REQUIRE(answer.data.size() <= sizeof report);
    std::memcpy(&report, answer.data.data(), answer.data.size());
    return report;
  }
  protocol::StoreReport report() { return get<protocol::StoreReport>(ReportId::store); }
  float held(Parameter parameter, ReportId of = ReportId::parameters) {
    return get<protocol::ParametersReport>(of).entries[static_cast<std::size_t>(parameter)].value;
  }
  /// Returns the board's values of all parameters.
  std::vector<float> values() {
    const auto report = get<protocol::ParametersReport>(ReportId::parameters);
    REQUIRE(report.count == protocol::parameter_count);
    std::vector<float> values;
    for (std::size_t i = 0; i < report.count; ++i) values.push_back(report.entries[i].value);
    return values;
  }
  float stiffness() { return held(Parameter::wall_stiffness_N_per_m); }
  void transact(protocol::ParameterOperation operation, std::vector<std::pair<Parameter, float>> values) {
    protocol::ParametersReport report{};
    report.operation = operation;
    for (const auto& [parameter, value] : values)
      report.entries[report.count++] = {protocol::info(parameter).id, 0, value};
    const std::size_t size = protocol::parameters_report_size(report.count);
    std::vector<std::byte> data(size);
    std::memcpy(data.data(), &report, size);
    bus.control(0x21, 9, 0x0311, 0, static_cast<std::uint16_t>(size), data);
    bus.run_for(0.001);
  }
  void set_stiffness(float value) {
    transact(protocol::ParameterOperation::set, {{Parameter::wall_stiffness_N_per_m, value}});
  }
  void send(Command command) {
    const protocol::CommandReport report{.command = command, .token = ++token};
    bus.send_report(report);
  }
  StoreResult carry_out(Command command) {
    send(command);
    bus.run_for(0.15);
    return report().result;
  }

  FirmwareOnBus bus;
  bool trial_is_due = true;  ///< the watchdog is tested after power-on
  unsigned resets = 0;       ///< other watchdog resets
  std::uint8_t token = 0;
};

}  // namespace

TEST_CASE("only stored parameters remain after a power cycle, and a factory reset erases them") {
  StoringBoard board;
  board.start();
  CHECK(board.report().contents == StoreContents::nothing);
  CHECK(board.report().differing == 0);
  board.set_stiffness(500.0f);
  CHECK(board.report().differing == 1);
  board.switch_off_and_on();
  CHECK(board.stiffness() == default_stiffness);

  board.set_stiffness(500.0f);
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  protocol::StoreReport report = board.report();
  CHECK(report.contents == StoreContents::parameters);
  CHECK(report.contents_at_start == StoreContents::nothing);
  CHECK(report.differing == 0);
  CHECK(report.commands == 1);
  CHECK(report.records_written == 1);
  const auto stores_left = report.stores_left;
  board.switch_off_and_on();
  CHECK(board.stiffness() == 500.0f);
  report = board.report();
  CHECK(report.contents_at_start == StoreContents::parameters);
  CHECK(report.parameter_table_hash == protocol::parameter_table_hash);
  CHECK(report.entries == protocol::parameter_count);
  CHECK(report.schema == protocol::store_schema);
  CHECK(report.unknown == 0);
  CHECK(report.out_of_range == 0);
  CHECK(report.stores_left == stores_left);

  // Unchanged values need no space in the store.
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  CHECK(board.report().records_written == 1);
  board.set_stiffness(600.0f);
  CHECK(board.held(Parameter::wall_stiffness_N_per_m, ReportId::stored) == 500.0f);
  board.transact(protocol::ParameterOperation::restore_stored, {});
  CHECK(board.stiffness() == 500.0f);
  CHECK(board.carry_out(Command::factory_reset) == StoreResult::done);
  CHECK(board.stiffness() == default_stiffness);
  CHECK(board.report().contents == StoreContents::factory_reset);
  board.switch_off_and_on();
  CHECK(board.stiffness() == default_stiffness);
  CHECK(board.report().contents_at_start == StoreContents::factory_reset);
  CHECK(board.carry_out(Command::factory_reset) == StoreResult::nothing_stored);
  CHECK(board.resets == 0);
  CHECK(board.bus.violations() == std::vector<std::string>{});
}

TEST_CASE("nothing is stored while the board tests itself") {
  StoringBoard board;
  board.start();
  board.send(Command::self_test);
  board.send(Command::store_parameters);
  board.bus.run_for(0.1);
  CHECK(board.report().result == StoreResult::force_is_on);
  CHECK(board.report().records_written == 0);
}

namespace {

/// Each interrupted operation is tested with this number of possible flash contents.
constexpr int tears = 4;
constexpr std::size_t store_offset = 0x8000, sector_bytes = 0x4000;

/// Writes directly to the chip's flash, because the firmware would need hours for these store contents.
class StoreSectors final : public link::FlashMemory {
 public:
  explicit StoreSectors(Chip& chip) : words_(reinterpret_cast<std::uint32_t*>(chip.flash().data() + store_offset)) {}
  std::span<const std::uint32_t> sector(std::size_t number) const override {
    return {words_ + number * sector_words, sector_words};
  }
  bool program(std::size_t sector, std::size_t word, std::uint32_t value) override {
    return (words_[sector * sector_words + word] &= value) == value;
  }
  void erase(std::size_t sector) override { std::fill_n(words_ + sector * sector_words, sector_words, 0xFFFF'FFFFu); }

 private:
  static constexpr std::size_t sector_words = sector_bytes / sizeof(std::uint32_t);
  std::uint32_t* words_;
};

using StoreImage = std::vector<std::uint32_t>;

StoreImage store_image(Chip& chip) {
  StoreImage image(protocol::store_sectors * sector_bytes / sizeof(std::uint32_t));
  std::memcpy(image.data(), chip.flash().data() + store_offset, protocol::store_sectors * sector_bytes);
  return image;
}

void put(const StoreImage& image, Chip& chip) {
  std::memcpy(chip.flash().data() + store_offset, image.data(), protocol::store_sectors * sector_bytes);
}

constexpr std::size_t entry_words = 2 * protocol::parameter_count;

/// Stores a complete parameter set with this stiffness in the format of this firmware.
void store_set(link::FlashLog& log, float stiffness, std::uint16_t schema = protocol::store_schema) {
  std::vector<std::uint32_t> entries;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    const auto& row = protocol::parameter_table[i];
    entries.push_back(row.id);
    entries.push_back(std::bit_cast<std::uint32_t>(
        i == static_cast<std::size_t>(Parameter::wall_stiffness_N_per_m) ? stiffness : row.default_value));
  }
  REQUIRE(log.begin({.schema = schema, .kind = static_cast<std::uint16_t>(link::RecordKind::parameters)}, entries));
  auto progress = link::FlashLog::Progress::under_way;
  while (progress == link::FlashLog::Progress::under_way) progress = log.step();
  REQUIRE(progress == link::FlashLog::Progress::done);
}

constexpr float stored_stiffness = 500.0f;

/// Stores sets until the free space is exactly this number of records.
void fill(Chip& chip, std::size_t (*left)(std::size_t room_of_blank)) {
  StoreSectors sectors(chip);
  link::FlashLog log;
  log.start(sectors);
  const std::size_t end = left(log.room(entry_words));
  while (log.room(entry_words) > end) store_set(log, stored_stiffness);
}

void spoil(Chip& chip, std::size_t sector) {
  std::mt19937 random(1);
  for (std::size_t i = 0; i < sector_bytes; ++i)
    chip.flash()[store_offset + sector * sector_bytes + i] = static_cast<std::uint8_t>(random());
}

struct Contents {
  std::string name;
  void (*make)(Chip&);
  float stiffness;         ///< value after the next start-up
  std::size_t sector = 0;  ///< sector that the next store writes
};

const Contents before_a_store[] = {
    {"nothing", [](Chip&) {}, default_stiffness},
    {"one set", [](Chip& chip) { fill(chip, [](std::size_t blank) { return blank - 1; }); }, stored_stiffness},
    {"a first sector that is full", [](Chip& chip) { fill(chip, [](std::size_t blank) { return blank / 2; }); },
     stored_stiffness, 1},
    {"a set of another schema",
     [](Chip& chip) {
       StoreSectors sectors(chip);
       link::FlashLog log;
       log.start(sectors);
       store_set(log, stored_stiffness, protocol::store_schema - 1);
     },
     default_stiffness},
};

const Contents before_an_erase[] = {
    {"both sectors full", [](Chip& chip) { fill(chip, [](std::size_t) { return std::size_t{0}; }); }, stored_stiffness},
    {"one set, and anything in the other sector",
     [](Chip& chip) {
       fill(chip, [](std::size_t blank) { return blank - 1; });
       spoil(chip, 1);
     },
     stored_stiffness},
    {"anything in both",
     [](Chip& chip) {
       spoil(chip, 0);
       spoil(chip, 1);
     },
     default_stiffness},
};

/// Starts a board and reads its parameters directly from memory. A USB request would take 0.25 s of board time.
struct ObservedStarts {
  explicit ObservedStarts(const Contents& contents) {
    contents.make(board.bus.chip);
    at_first = store_image(board.bus.chip);
    board.switch_off_and_on();
    REQUIRE(board.stiffness() == contents.stiffness);
    old_set = board.values();
    const auto addresses = addresses_of(old_set);
    board.transact(protocol::ParameterOperation::set,
                   {{Parameter::wall_stiffness_N_per_m, 600.0f}, {Parameter::force_limit_N, 1.5f}});
    new_set = board.values();
    REQUIRE(new_set != old_set);
    for (const std::uint32_t address : addresses)
      if (values_at(address) == new_set) held_at = address;
    REQUIRE(held_at != 0);
  }

  /// Returns the parameters when the converters are first triggered.
  std::vector<float> after_power_on(const StoreImage& flash) {
    Chip& chip = board.bus.chip;
    put(flash, chip);
    bool samples = false;
    chip.on_injected_sequence = [&](std::uint64_t, Ticks) {
      samples = true;
      chip.request_stop();
    };
    chip.reset(ResetCause::power_on);
    for (int i = 0; i < 200 && !samples; ++i) board.bus.run_for(0.01);
    chip.on_injected_sequence = nullptr;
    REQUIRE(samples);
    return values_at(held_at);
  }

  StoringBoard board;
  StoreImage at_first;
  std::vector<float> old_set, new_set;

 private:
  std::vector<float> values_at(std::uint32_t address) {
    std::vector<float> values(protocol::parameter_count);
    const auto bytes = std::as_writable_bytes(std::span(values));
    REQUIRE(board.bus.chip.debug_port().read(address, {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()}));
    return values;
  }
  /// Returns all addresses of these values in SRAM2.
  std::vector<std::uint32_t> addresses_of(const std::vector<float>& values) {
    constexpr std::uint32_t begin = virtual_board::sram_base + virtual_board::sram1_bytes;
    std::vector<float> memory((virtual_board::sram_bytes - virtual_board::sram1_bytes) / sizeof(float));
    const auto bytes = std::as_writable_bytes(std::span(memory));
    REQUIRE(board.bus.chip.debug_port().read(begin, {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()}));
    std::vector<std::uint32_t> addresses;
    for (auto found = memory.begin();
         (found = std::search(found, memory.end(), values.begin(), values.end())) != memory.end(); ++found)
      addresses.push_back(begin +
                          static_cast<std::uint32_t>(sizeof(float) * static_cast<std::size_t>(found - memory.begin())));
    return addresses;
  }

  std::uint32_t held_at = 0;
};

/// A programmed word and its position in the store.
struct Word {
  std::size_t index;
  std::uint32_t value;
};

/// Makes the board store its parameters, and observes its flash.
std::vector<Word> words_of_a_store(StoringBoard& board) {
  std::vector<Word> words;
  StoreImage seen = store_image(board.bus.chip);
  const std::uint64_t before = board.bus.chip.flash_operations();
  board.send(Command::store_parameters);
  constexpr double step_s = 0.00005;  // a word takes ten steps
  for (int i = 0; i < 4000; ++i) {
    board.bus.run_for(step_s);
    const std::uint64_t operations = board.bus.chip.flash_operations() - before;
    if (operations == words.size()) continue;
    REQUIRE(operations == words.size() + 1);
    const StoreImage now = store_image(board.bus.chip);
    const auto changed = std::ranges::mismatch(seen, now).in2;
    REQUIRE(changed != now.end());
    words.push_back({static_cast<std::size_t>(changed - now.begin()), *changed});
    seen[words.back().index] = *changed;
    REQUIRE(seen == now);
  }
  REQUIRE(board.report().result == StoreResult::done);
  return words;
}

}  // namespace

// This test writes the result of a power cut directly to the flash, because only the flash survives a power cut. A real
// power cut would require a self-test at each word.
TEST_CASE("a power cut at any word of a store leaves all of the old parameters or all of the new ones") {
  for (const Contents& contents : before_a_store) {
    CAPTURE(contents.name);
    ObservedStarts starts(contents);
    const std::vector<Word> words = words_of_a_store(starts.board);
    REQUIRE(words.size() > 2 * protocol::parameter_count);
    CHECK(words.front().index / (sector_bytes / sizeof(std::uint32_t)) == contents.sector);
    StoreImage flash = starts.at_first;
    std::mt19937 random(1);
    for (std::size_t cut = 0; cut < words.size(); ++cut) {
      CAPTURE(cut);
      const auto [index, value] = words[cut];
      const std::uint32_t erased = flash[index];
      enum Extent : unsigned { nothing, all, some, some_too };
      const auto extent = static_cast<Extent>(random() % 4);
      flash[index] = extent == nothing ? erased : extent == all ? value : erased & (value | random());
      const bool is_whole = cut + 1 == words.size() && flash[index] == value;
      CHECK(starts.after_power_on(flash) == (is_whole ? starts.new_set : starts.old_set));
      flash[index] = value;
    }
    CHECK(starts.after_power_on(flash) == starts.new_set);
  }
}

TEST_CASE("a power cut at any word and any erase of a start leaves the parameters that were stored") {
  for (const Contents& contents : before_an_erase) {
    CAPTURE(contents.name);
    ObservedStarts starts(contents);
    Chip& chip = starts.board.bus.chip;
    const std::uint64_t before = chip.flash_operations();
    REQUIRE(starts.after_power_on(starts.at_first) == starts.old_set);
    const std::uint64_t operations = chip.flash_operations() - before;
    REQUIRE(operations > 0);
    for (std::uint64_t cut = 1; cut <= operations; ++cut)
      for (int tear = 0; tear < tears; ++tear) {
        CAPTURE(cut);
        unsigned power_ons = 0;
        chip.on_reset = [&](ResetCause cause) { power_ons += cause == ResetCause::power_on ? 1 : 0; };
        chip.cut_power_at_flash_operation(cut);
        CHECK(starts.after_power_on(starts.at_first) == starts.old_set);
        CHECK(power_ons == 2);
        chip.on_reset = nullptr;
      }
  }
}

TEST_CASE("a store that a power cut of the chip ends leaves the old parameters or the new ones, and the next is kept") {
  std::vector<std::uint8_t> old_flash;
  std::uint64_t words = 0;
  {
    StoringBoard board;
    board.start();
    board.set_stiffness(500.0f);
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    old_flash.assign(board.bus.chip.flash().begin(), board.bus.chip.flash().end());
    board.set_stiffness(600.0f);
    const std::uint64_t before = board.bus.chip.flash_operations();
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    words = board.bus.chip.flash_operations() - before;
  }
  REQUIRE(words > 2 * protocol::parameter_count);
  for (const std::uint64_t cut : {std::uint64_t{1}, words / 2, words - 1, words}) {
    CAPTURE(cut);
    StoringBoard board({.random_seed = static_cast<std::uint32_t>(cut)});
    std::memcpy(board.bus.chip.flash().data(), old_flash.data(), old_flash.size());
    board.bus.chip.reset(ResetCause::power_on);
    board.start();
    REQUIRE(board.stiffness() == 500.0f);
    board.set_stiffness(600.0f);
    board.bus.chip.cut_power_at_flash_operation(cut);
    board.send(Command::store_parameters);
    board.bus.run_for(0.15);
    board.switch_off_and_on();
    const float found = board.stiffness();
    CHECK((found == 500.0f || (found == 600.0f && cut == words)));
    CHECK(board.report().contents_at_start == StoreContents::parameters);
    board.set_stiffness(700.0f);
    REQUIRE(board.carry_out(Command::store_parameters) == StoreResult::done);
    board.switch_off_and_on();
    CHECK(board.stiffness() == 700.0f);
  }
}

TEST_CASE("a store does not delay the control interrupt or the poses, even with the slowest flash") {
  for (const bool slowest : {false, true}) {
    CAPTURE(slowest);
    StoringBoard board({.slowest_flash = slowest});
    board.start();
    board.set_stiffness(500.0f);
    Ticks last = 0, longest = 0;
    board.bus.on_pose = [&](const protocol::PoseReport&) {
      if (last != 0) longest = std::max(longest, board.bus.chip.now() - last);
      last = board.bus.chip.now();
    };
    board.bus.keep_asking_for_poses();
    board.bus.run_for(0.02);
    REQUIRE(longest > 0);
    longest = 0;
    CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
    // Two poses are up to 2 ms apart, because a pose may arrive anywhere in its frame.
    CHECK(longest < ticks(0.0021));
    const auto information = board.get<protocol::InformationReport>(ReportId::information);
    CHECK(information.servo_overruns == 0);
    CHECK(information.pose_reports_dropped == 0);
    CHECK(board.resets == 0);
  }
}

TEST_CASE("a start with a flash erase takes longer, and the watchdog does not expire on the slowest flash") {
  StoringBoard board({.low_speed_internal_Hz = 47'000, .slowest_flash = true});
  constexpr std::size_t second_sector = 0xC000;
  board.bus.chip.flash()[second_sector + 100] = 0;  // result of an interrupted erase
  board.bus.chip.reset(ResetCause::power_on);
  board.bus.plug(false);
  board.bus.run_for(0.6);
  board.bus.plug(true);
  board.start();
  CHECK(board.bus.chip.flash()[second_sector + 100] == 0xFF);
  CHECK(board.report().sector_erases[1] == 1);
  CHECK(board.resets == 0);
  board.set_stiffness(500.0f);
  CHECK(board.carry_out(Command::store_parameters) == StoreResult::done);
  CHECK(board.get<protocol::InformationReport>(ReportId::information).servo_overruns == 0);
}

}  // namespace inkwell::virtual_usb_test
