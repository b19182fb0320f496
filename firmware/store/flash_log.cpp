#include "firmware/store/flash_log.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace inkwell::link {
namespace {

constexpr std::uint32_t erased = 0xFFFF'FFFF;
constexpr std::uint32_t sector_magic = 0x5357'4B49, record_magic = 0x5257'4B49;  // "IKWS", "IKWR"
constexpr std::size_t sector_head_words = 5;
/// Space reserved in each sector for erase records. Each interrupted erase uses one erase record.
constexpr std::size_t words_for_notes = 8 * record_words(1);

/// CRC-32 of IEEE 802.3, without the final inversion.
constexpr std::uint32_t check_begin = 0xFFFF'FFFF;
std::uint32_t add_to_check(std::uint32_t check, std::uint32_t word) {
  static constexpr auto table = []() {
    std::array<std::uint32_t, 16> rows{};
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      rows[i] = i;
      for (int bit = 0; bit < 4; ++bit) rows[i] = rows[i] >> 1 ^ ((rows[i] & 1) != 0 ? 0xEDB8'8320u : 0u);
    }
    return rows;
  }();
  check ^= word;
  for (int i = 0; i < 8; ++i) check = check >> 4 ^ table[check & 0xF];
  return check;
}

std::uint32_t check_of(std::span<const std::uint32_t> words) {
  std::uint32_t check = check_begin;
  for (const std::uint32_t word : words) check = add_to_check(check, word);
  return check;
}

/// Returns the record at the beginning of `words` if the record is complete.
std::optional<FlashLog::Record> record_at(std::span<const std::uint32_t> words) {
  if (words[0] != record_magic || words.size() < record_words(0)) return std::nullopt;
  FlashLog::Record record;
  std::memcpy(&record.head, words.data(), sizeof record.head);
  const std::size_t room = words.size() - record_words(0);
  if (record.head.payload > room) return std::nullopt;
  record.payload = words.subspan(record_head_words, record.head.payload);
  const std::size_t last = record_head_words + record.head.payload;
  return check_of(words.first(last)) == words[last] ? std::optional(record) : std::nullopt;
}

}  // namespace

void FlashLog::start(FlashMemory& memory) {
  *this = {};
  memory_ = &memory;
  for (std::size_t number = 0; number < sectors_.size(); ++number) scan(number);
  for (std::size_t number = 0; number < sectors_.size(); ++number)
    // A sector whose header is newer than its erase record has been erased completely.
    if (erase_is_open_[number] && sectors_[number].is_begun)
      erase_is_open_[number] = memory.sector(number)[2] < erases_[number];
  choose_current();
  make_room();
}

void FlashLog::scan(std::size_t number) {
  const std::span<const std::uint32_t> words = memory_->sector(number);
  Sector& sector = sectors_[number];
  sector.end = words.size();
  while (sector.end > 0 && words[sector.end - 1] == erased) --sector.end;
  sector.is_begun = words[0] == sector_magic && check_of(words.first(sector_head_words - 1)) == words[4];
  if (!sector.is_begun) return;
  sector.order = words[1];
  erases_[number] = std::max(erases_[number], words[2]);
  erases_[1 - number] = std::max(erases_[1 - number], words[3]);
  sector.end = std::max(sector.end, sector_head_words);  // a CRC may be equal to an erased word
  for (std::size_t at = sector_head_words; at < sector.end;) {
    const auto record = record_at(words.subspan(at));
    if (record) note(number, *record);
    at += record ? record_words(record->payload.size()) : 1;
    if (record) sector.end = std::max(sector.end, at);
  }
}

void FlashLog::note(std::size_t sector, const Record& record) {
  last_number_ = std::max(last_number_, record.head.number);
  if (record.head.kind == static_cast<std::uint16_t>(RecordKind::erase) && record.payload.size() == 1) {
    erases_[1 - sector] = std::max(erases_[1 - sector], record.payload[0]);
    erase_is_open_[1 - sector] = true;
  } else if (!newest_ || record.head.number > newest_->head.number) {
    newest_ = record;
    current_ = sector;
  }
}

/// Without a valid record, chooses the sector with the newest header, or an erased sector.
void FlashLog::choose_current() {
  if (newest_) return;
  const bool second_is_newer = sectors_[1].is_begun && (!sectors_[0].is_begun || sectors_[1].order > sectors_[0].order);
  const bool first_is_useless = !is_usable(0) && !sectors_[0].is_begun;
  current_ = second_is_newer || (first_is_useless && is_usable(1)) ? 1 : 0;
}

/// Returns true if the sector has no records. The sector may have a header.
bool FlashLog::is_usable(std::size_t number) const {
  const Sector& sector = sectors_[number];
  return !erase_is_open_[number] && sector.end <= (sector.is_begun ? sector_head_words : 0);
}

bool FlashLog::fits(std::size_t number, std::size_t words) const {
  const std::size_t end = std::max(sectors_[number].end, sector_head_words);
  return end + words + words_for_notes <= memory_->sector(number).size();
}

void FlashLog::make_room() {
  if (!sectors_[current_].is_begun && !is_usable(current_)) return erase(current_);
  if (!is_usable(other())) erase(other());
}

// The erase continues even if the erase record cannot be written.
void FlashLog::erase(std::size_t number) {
  const std::uint32_t erases = ++erases_[number];
  const std::size_t other_sector = 1 - number;
  if (sectors_[other_sector].is_begun &&
      sectors_[other_sector].end + record_words(1) <= memory_->sector(other_sector).size()) {
    const std::size_t current = std::exchange(current_, other_sector);
    prepare({.schema = protocol::store_schema, .kind = static_cast<std::uint16_t>(RecordKind::erase)}, {&erases, 1});
    while (step() == Progress::under_way) {
    }
    current_ = current;
  }
  memory_->erase(number);
  erase_is_open_[number] = false;
  scan(number);
  if (sectors_[number].end != 0) return;
  prepare_sector(number);
  while (!sectors_[number].is_begun && program_sector_head(number)) {
  }
}

bool FlashLog::program(std::size_t number, std::uint32_t word) {
  std::size_t& end = sectors_[number].end;
  return memory_->program(number, end++, word);
}

void FlashLog::prepare_sector(std::size_t number) {
  sectors_[number].order = std::max(sectors_[0].order, sectors_[1].order) + 1;
  sector_head_ = {sector_magic, sectors_[number].order, erases_[number], erases_[1 - number], 0};
  sector_head_.back() = check_of(std::span(sector_head_).first<sector_head_words - 1>());
}

/// Programs the next word of the sector header.
bool FlashLog::program_sector_head(std::size_t number) {
  Sector& sector = sectors_[number];
  const bool taken = program(number, sector_head_[sector.end]);
  sector.is_begun = taken && sector.end == sector_head_words;
  return taken;
}

std::size_t FlashLog::room(std::size_t payload) const {
  if (memory_ == nullptr) return 0;
  const std::size_t words = record_words(payload);
  const auto records_in = [&](std::size_t number) -> std::size_t {
    const std::size_t end = std::max(sectors_[number].end, sector_head_words) + words_for_notes;
    const std::size_t size = memory_->sector(number).size();
    return end < size ? (size - end) / words : 0;
  };
  const bool may_write = sectors_[current_].is_begun || is_usable(current_);
  return (may_write ? records_in(current_) : 0) + (is_usable(other()) ? records_in(other()) : 0);
}

bool FlashLog::begin(RecordHead head, std::span<const std::uint32_t> payload) {
  if (room(payload.size()) == 0) return false;
  const bool may_write = sectors_[current_].is_begun || is_usable(current_);
  if (!may_write || !fits(current_, record_words(payload.size()))) current_ = other();
  if (!sectors_[current_].is_begun) prepare_sector(current_);
  prepare(head, payload);
  return true;
}

void FlashLog::prepare(RecordHead head, std::span<const std::uint32_t> payload) {
  head_ = head;
  head_.magic = record_magic;
  head_.number = ++last_number_;
  head_.payload = static_cast<std::uint32_t>(payload.size());
  payload_ = payload;
  written_ = 0;
  check_ = check_begin;
}

FlashLog::Progress FlashLog::step() {
  if (!sectors_[current_].is_begun) return program_sector_head(current_) ? Progress::under_way : Progress::failed;
  const std::size_t last = record_head_words + payload_.size();
  std::array<std::uint32_t, record_head_words> head;
  std::memcpy(head.data(), &head_, sizeof head_);
  const std::uint32_t word = written_ < record_head_words ? head[written_]
                             : written_ < last            ? payload_[written_ - record_head_words]
                                                          : check_;
  if (!program(current_, word)) return Progress::failed;
  check_ = add_to_check(check_, word);
  if (++written_ <= last) return Progress::under_way;
  if (head_.kind != static_cast<std::uint16_t>(RecordKind::erase))
    newest_ = record_at(memory_->sector(current_).subspan(sectors_[current_].end - record_words(payload_.size())));
  return Progress::done;
}

}  // namespace inkwell::link
