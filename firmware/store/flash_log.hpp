// Log of records in two flash sectors. The newest complete record is valid. After a power loss during any write or
// erase, the previous or the new record is valid.
//
// A sector begins with five words: magic, sequence number, erase count of this sector, erase count of the other sector,
// and CRC. The records follow this sector header. A record consists of a header of seven words (RecordHead), a payload,
// and the CRC of header and payload. The CRC is written last. A record with a wrong CRC is skipped, and its space is
// lost until the sector is erased.
//
// New records are written to the sector of the newest record. If the sector is full, new records are written to the
// other sector. Only start() erases a sector. If the sector for the next record is not empty, start() erases this
// sector. Before the erase, start() writes an erase record to the other sector. An interrupted erase is therefore
// repeated and counted, even if the sector already reads as erased.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/store.hpp"

namespace inkwell::link {

/// Memory of the log: two flash sectors.
class FlashMemory {
 public:
  virtual std::span<const std::uint32_t> sector(std::size_t number) const = 0;
  /// Programs an erased word. Returns true if the programmed word reads as `value`.
  virtual bool program(std::size_t sector, std::size_t word, std::uint32_t value) = 0;
  virtual void erase(std::size_t sector) = 0;

 protected:
  ~FlashMemory() = default;
};

enum class RecordKind : std::uint8_t { parameters = 1, factory_reset = 2, erase = 3 };

/// The first three words and the last word of a record have the same position in every schema.
struct RecordHead {
  std::uint32_t magic;
  std::uint16_t schema;
  std::uint16_t kind;     ///< RecordKind
  std::uint32_t number;   ///< record number, counted over the life of the board
  std::uint32_t payload;  ///< in words
  std::uint32_t firmware_version;
  std::uint32_t parameter_table_hash;
  std::uint32_t force_law_hash;
};
inline constexpr std::size_t record_head_words = sizeof(RecordHead) / sizeof(std::uint32_t);

/// Returns the record size in words.
constexpr std::size_t record_words(std::size_t payload) { return record_head_words + payload + 1; }

class FlashLog {
 public:
  struct Record {
    RecordHead head;
    std::span<const std::uint32_t> payload;
  };
  enum class Progress : std::uint8_t { under_way, done, failed };

  /// Reads both sectors. Erases one sector if necessary.
  void start(FlashMemory& memory);

  /// Returns the newest complete record that is not an erase record.
  const std::optional<Record>& newest() const { return newest_; }
  /// Number of records over the life of the board.
  std::uint32_t records_written() const { return last_number_; }
  const std::array<std::uint32_t, protocol::store_sectors>& erases() const { return erases_; }
  /// Returns the remaining space in records of this payload size.
  std::size_t room(std::size_t payload) const;

  /// Starts writing a record. The caller sets all members of `head` except magic, number and payload. Returns false if
  /// there is no space. `payload` must remain valid until step() returns `done` or `failed`.
  [[nodiscard]] bool begin(RecordHead head, std::span<const std::uint32_t> payload);
  /// Programs one word of the record. After a failure, newest() returns the previous record.
  Progress step();

 private:
  struct Sector {
    bool is_begun = false;  ///< the sector header is valid
    std::uint32_t order = 0;
    std::size_t end = 0;  ///< index of the first word from which on all words are erased
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
  std::array<std::uint32_t, protocol::store_sectors> erases_{};  ///< started erases
  std::array<bool, protocol::store_sectors> erase_is_open_{};    ///< started erases that may be incomplete
  std::optional<Record> newest_;
  std::uint32_t last_number_ = 0;
  std::size_t current_ = 0;
  // State of the record that is being written.
  std::array<std::uint32_t, 5> sector_head_{};
  RecordHead head_{};
  std::span<const std::uint32_t> payload_;
  std::size_t written_ = 0;  ///< number of written words
  std::uint32_t check_ = 0;  ///< CRC of the written words
};

}  // namespace inkwell::link
