// Records in two sectors of a flash, of which the newest whole one counts: a power cut at any word or erase leaves what
// counted before, or what was being written.
//
// A sector begins with five words: magic, its place in the order of all that were begun, how often it was erased, how
// often the other one, and the CRC of these. Behind them follow records: seven words (RecordHead), its payload, and the
// CRC of all of it, which is written last. A record without its right CRC is skipped; its room is lost until the sector
// is erased. While the board runs only words are programmed: into the sector of the newest record, then, once that is
// full, into the other one if it has been erased. Erasing is for start(), once at most: the sector that will be written
// next, if anything else stands in it. Before that a note of the erase goes into the sector that stays, so that one
// which was cut off is known, even if its sector reads as erased, and is counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <protocol/store.hpp>

namespace inkwell::link {

/// The two sectors.
class FlashMemory {
 public:
  virtual std::span<const std::uint32_t> sector(std::size_t number) const = 0;
  /// Programs an erased word, and tells whether it reads as it should then.
  virtual bool program(std::size_t sector, std::size_t word, std::uint32_t value) = 0;
  virtual void erase(std::size_t sector) = 0;

 protected:
  ~FlashMemory() = default;
};

enum class RecordKind : std::uint8_t { parameters = 1, factory_reset = 2, erase = 3 };

/// The first three and the last words are laid out alike in every schema.
struct RecordHead {
  std::uint32_t magic;
  std::uint16_t schema;
  std::uint16_t kind;     ///< RecordKind
  std::uint32_t number;   ///< one more each time, in the board's life
  std::uint32_t payload;  ///< in words
  std::uint32_t firmware_version;
  std::uint32_t parameter_table_hash;
  std::uint32_t force_law_hash;
};
inline constexpr std::size_t record_head_words = sizeof(RecordHead) / sizeof(std::uint32_t);

/// Words that a record with so much payload takes.
constexpr std::size_t record_words(std::size_t payload) { return record_head_words + payload + 1; }

class FlashLog {
 public:
  struct Record {
    RecordHead head;
    std::span<const std::uint32_t> payload;
  };
  enum class Progress : std::uint8_t { under_way, done, failed };

  /// Reads both sectors, and erases one if there is something in it where the next record may have to go.
  void start(FlashMemory& memory);

  /// The newest whole record that is not the note of an erase.
  const std::optional<Record>& newest() const { return newest_; }
  /// In the board's life.
  std::uint32_t records_written() const { return last_number_; }
  const std::array<std::uint32_t, protocol::store_sectors>& erases() const { return erases_; }
  /// How many records of so much payload still go into the flash without an erase.
  std::size_t room(std::size_t payload) const;

  /// Begins to write a record; `head` needs all but magic, number and payload. False if there is no room. `payload`
  /// must last until step() says that it is over.
  [[nodiscard]] bool begin(RecordHead head, std::span<const std::uint32_t> payload);
  /// Programs one word of it. After a failure what was newest still is.
  Progress step();

 private:
  struct Sector {
    bool is_begun = false;  ///< its head is right
    std::uint32_t order = 0;
    std::size_t end = 0;  ///< first word behind which all is erased
  };

  void scan(std::size_t number);
  void note(std::size_t sector, const Record& record);
  void choose_current();
  bool is_usable(std::size_t number) const;
  bool fits(std::size_t number, std::size_t words) const;
  void make_room();
  void erase(std::size_t number);
  void prepare_sector(std::size_t number);
  bool program_sector_head(std::size_t number);
  void prepare(RecordHead head, std::span<const std::uint32_t> payload);
  bool program(std::size_t number, std::uint32_t word);
  std::size_t other() const { return 1 - current_; }

  FlashMemory* memory_ = nullptr;
  std::array<Sector, protocol::store_sectors> sectors_{};
  std::array<std::uint32_t, protocol::store_sectors> erases_{};  ///< begun
  std::array<bool, protocol::store_sectors> erase_is_open_{};    ///< begun, and perhaps not ended
  std::optional<Record> newest_;
  std::uint32_t last_number_ = 0;
  std::size_t current_ = 0;
  // What is being written.
  std::array<std::uint32_t, 5> sector_head_{};
  RecordHead head_{};
  std::span<const std::uint32_t> payload_;
  std::size_t written_ = 0;  ///< of its words
  std::uint32_t check_ = 0;  ///< of these
};

}  // namespace inkwell::link
