// Tests the flash log with any flash content and with power losses during writes and erases. After a power loss, the
// next start finds the previous set or the new set, and can store another set.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "firmware/store/flash_log.hpp"

namespace inkwell::link {
namespace {

constexpr std::size_t sector_words = 0x4000 / 4;
constexpr std::uint32_t erased = 0xFFFF'FFFF;

struct PowerCut {};

/// Flash memory with the behavior of the chip's flash. Programming can clear bits but cannot set bits. A power loss
/// leaves the interrupted word or sector partly written.
class FakeFlash final : public FlashMemory {
 public:
  FakeFlash() {
    for (auto& sector : sectors) sector.assign(sector_words, erased);
  }
  std::span<const std::uint32_t> sector(std::size_t number) const override { return sectors[number]; }
  bool program(std::size_t sector, std::size_t word, std::uint32_t value) override {
    std::uint32_t& cell = sectors.at(sector).at(word);
    if (cell != erased) ++overwritten;
    const std::uint32_t before = cell;
    cell &= value;
    if (cuts()) {
      cell = tear == 0 ? before : tear == 1 ? cell : before & (cell | random());
      throw PowerCut{};
    }
    return cell == value && !broken;
  }
  void erase(std::size_t sector) override {
    const std::vector<std::uint32_t> before = sectors.at(sector);
    sectors[sector].assign(sector_words, erased);
    ++erases[sector];
    if (!cuts()) return;
    if (tear == 0) sectors[sector] = before;
    if (tear == 2)
      for (std::size_t i = 0; i < sector_words; ++i) {
        const std::uint32_t kind = random() % 3;
        sectors[sector][i] = kind == 0 ? before[i] : kind == 1 ? erased : random();
      }
    throw PowerCut{};
  }
  std::uint32_t random() { return seed = seed * 1664525 + 1013904223, seed ^ seed >> 15; }

  std::array<std::vector<std::uint32_t>, 2> sectors;
  std::array<std::uint32_t, 2> erases{};
  unsigned overwritten = 0, operations = 0, cut_at = 0, tear = 0;
  std::uint32_t seed = 1;
  bool broken = false;

 private:
  bool cuts() { return ++operations == cut_at; }
};

constexpr std::size_t payload_words = 20;
using Payload = std::array<std::uint32_t, payload_words>;

Payload payload_of(std::uint32_t set) {
  Payload payload;
  for (std::uint32_t i = 0; i < payload.size(); ++i) payload[i] = set * 1000 + i;
  return payload;
}

/// Returns the number of the stored set, or 0 if no set is stored. Fails the test if the content differs from every
/// stored set.
std::uint32_t held(const FlashLog& log) {
  if (!log.newest()) return 0;
  const auto payload = log.newest()->payload;
  REQUIRE(payload.size() == payload_words);
  const std::uint32_t set = payload[0] / 1000;
  const Payload expected = payload_of(set);
  for (std::size_t i = 0; i < payload.size(); ++i) CHECK(payload[i] == expected[i]);
  return set;
}

bool store(FlashLog& log, std::uint32_t set) {
  const Payload payload = payload_of(set);
  if (!log.begin({.schema = protocol::store_schema, .kind = static_cast<std::uint16_t>(RecordKind::parameters)},
                 payload))
    return false;
  FlashLog::Progress progress;
  do progress = log.step();
  while (progress == FlashLog::Progress::under_way);
  return progress == FlashLog::Progress::done;
}

FlashLog started(FlashMemory& flash) {
  FlashLog log;
  log.start(flash);
  return log;
}

/// Stores sets with numbers from `first` on, until there is space for `left` records.
std::uint32_t fill(FakeFlash& flash, std::uint32_t first, std::size_t left) {
  FlashLog log = started(flash);
  while (log.room(payload_words) > left) REQUIRE(store(log, first++));
  return first - 1;
}

struct Begin {
  std::string name;
  /// Fills the flash and returns the number of the stored set, or 0.
  std::function<std::uint32_t(FakeFlash&)> make;
};

void scatter(FakeFlash& flash, std::size_t sector) {
  for (std::uint32_t& word : flash.sectors[sector]) word = flash.random();
}

const std::vector<Begin>& begins() {
  static const std::vector<Begin> all{
      {"blank", [](FakeFlash&) { return 0u; }},
      {"one record",
       [](FakeFlash& flash) {
         FlashLog log = started(flash);
         REQUIRE(store(log, 1));
         return 1u;
       }},
      {"first sector nearly full, second erased",
       [](FakeFlash& flash) {
         const std::size_t both = started(flash).room(payload_words);
         return fill(flash, 1, both / 2 + 1);
       }},
      {"first sector full, second erased",
       [](FakeFlash& flash) {
         const std::size_t both = started(flash).room(payload_words);
         return fill(flash, 1, both / 2);
       }},
      {"both full", [](FakeFlash& flash) { return fill(flash, 1, 0); }},
      {"the second begun after the first was full, third round",
       [](FakeFlash& flash) {
         std::uint32_t last = fill(flash, 1, 0);
         last = fill(flash, last + 1, 0);
         return fill(flash, last + 1, 3);
       }},
      {"garbage in the first",
       [](FakeFlash& flash) {
         scatter(flash, 0);
         return 0u;
       }},
      {"garbage in both",
       [](FakeFlash& flash) {
         scatter(flash, 0);
         scatter(flash, 1);
         return 0u;
       }},
      {"a record in the first, garbage in the second",
       [](FakeFlash& flash) {
         FlashLog log = started(flash);
         REQUIRE(store(log, 1));
         scatter(flash, 1);
         return 1u;
       }},
      {"a torn head",
       [](FakeFlash& flash) {
         FlashLog log = started(flash);
         REQUIRE(store(log, 1));
         flash.sectors[0][4] &= 0x0F0F'0F0F;
         return 0u;
       }},
      {"a torn head of the second",
       [](FakeFlash& flash) {
         const std::uint32_t last = fill(flash, 1, started(flash).room(payload_words) / 2);
         flash.sectors[1][0] = 0x5757'4B49;
         return last;
       }},
      {"a torn record behind a whole one",
       [](FakeFlash& flash) {
         FlashLog log = started(flash);
         REQUIRE(store(log, 1));
         REQUIRE(store(log, 2));
         flash.sectors[0][5 + record_words(payload_words) + 12] &= 0xFF00'FF00;
         return 1u;
       }},
      {"an erase that was cut off",
       [](FakeFlash& flash) {
         const std::uint32_t last = fill(flash, 1, 0);
         const unsigned before = flash.operations;
         flash.cut_at = before + static_cast<unsigned>(record_words(1)) + 1;
         flash.tear = 2;
         CHECK_THROWS_AS(started(flash), PowerCut);
         CHECK(flash.erases[0] == 1);
         flash.cut_at = 0;
         return last;
       }},
  };
  return all;
}

/// Starts a log and stores a set.
void start_and_store(FakeFlash& flash, std::uint32_t set) {
  FlashLog log = started(flash);
  const bool stored = store(log, set);  // outside the check macro, which would catch the exception of the power loss
  REQUIRE(stored);
}

}  // namespace

TEST_CASE("store: a power cut at any word or erase leaves the old set or the new one, and the next can be stored") {
  for (const Begin& begin : begins()) {
    CAPTURE(begin.name);
    FakeFlash at_first;
    const std::uint32_t old_set = begin.make(at_first);
    at_first.overwritten = 0;
    constexpr std::uint32_t new_set = 900;
    FakeFlash whole = at_first;
    start_and_store(whole, new_set);
    const unsigned operations = whole.operations - at_first.operations;
    CHECK(operations >= record_words(payload_words));
    CHECK(held(started(whole)) == new_set);
    for (unsigned cut = 1; cut <= operations; ++cut)
      for (unsigned tear = 0; tear < 4; ++tear) {
        CAPTURE(cut);
        CAPTURE(tear);
        FakeFlash flash = at_first;
        flash.cut_at = flash.operations + cut;
        flash.tear = tear < 3 ? tear : 2;
        flash.seed = 77 * cut + tear;
        CHECK_THROWS_AS(start_and_store(flash, new_set), PowerCut);
        flash.overwritten = 0;
        FlashLog log = started(flash);
        const std::uint32_t set = held(log);
        CAPTURE(set);
        CAPTURE(old_set);
        CHECK((set == old_set || (set == new_set && cut == operations)));
        // Each started erase is counted. The record of the last erase may be incomplete.
        for (std::size_t i = 0; i < 2 && old_set != 0; ++i) {
          CHECK(log.erases()[i] + 1 >= flash.erases[i]);
          CHECK(log.erases()[i] <= flash.erases[i] + 1);
        }
        REQUIRE(store(log, new_set + 1));
        CHECK(held(started(flash)) == new_set + 1);
        CHECK(flash.overwritten == 0);
      }
  }
}

TEST_CASE("store: every start leaves room, at most one sector is erased at a start, and none without need") {
  FakeFlash flash;
  std::uint32_t set = 1;
  for (int start = 0; start < 40; ++start) {
    const auto before = flash.erases[0] + flash.erases[1];
    FlashLog log = started(flash);
    CHECK(flash.erases[0] + flash.erases[1] <= before + 1);
    CHECK(log.room(payload_words) > 50);
    while (log.room(payload_words) > (start % 3 == 0 ? 0 : 60)) REQUIRE(store(log, set++));
    CHECK(held(log) == set - 1);
    if (start % 3 == 0) CHECK_FALSE(store(log, set));
    CHECK(held(started(flash)) == set - 1);
  }
  CHECK(flash.erases[0] > 2);
  CHECK(flash.erases[1] > 2);
  const FlashLog log = started(flash);
  CHECK(log.erases() == flash.erases);
  const auto erases = flash.erases;
  for (int i = 0; i < 3; ++i) static_cast<void>(started(flash));
  CHECK(flash.erases == erases);
  CHECK(flash.overwritten == 0);
}

TEST_CASE("store: data at the position of the next record is erased at start-up and counted") {
  FakeFlash flash;
  flash.sectors[1][25] = 0xFFFF'FF00;
  const FlashLog log = started(flash);
  CHECK(flash.erases[1] == 1);
  CHECK(log.erases()[1] == 1);
  CHECK(started(flash).erases()[1] == 1);
  CHECK(flash.erases[0] + flash.erases[1] == 1);
}

TEST_CASE("store: a flash that refuses a word causes an error, and the newest record remains valid") {
  FakeFlash flash;
  FlashLog log = started(flash);
  REQUIRE(store(log, 1));
  flash.broken = true;
  CHECK_FALSE(store(log, 2));
  CHECK(held(log) == 1);
  CHECK(held(started(flash)) == 1);
  flash.broken = false;
  REQUIRE(store(log, 3));
  CHECK(held(started(flash)) == 3);
}

TEST_CASE("store: an erase that was cut off is done again even if the sector reads as erased") {
  FakeFlash flash;
  const std::uint32_t last = fill(flash, 1, 0);
  flash.cut_at = flash.operations + static_cast<unsigned>(record_words(1)) + 1;
  flash.tear = 1;  // the sector reads as erased, but the erase is incomplete
  CHECK_THROWS_AS(started(flash), PowerCut);
  REQUIRE(flash.erases[0] == 1);
  const FlashLog log = started(flash);
  CHECK(flash.erases[0] == 2);
  CHECK(log.erases()[0] == 2);
  CHECK(held(log) == last);
}

}  // namespace inkwell::link
