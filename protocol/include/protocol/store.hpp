// The parameter store: what the board keeps in its flash, and the report that tells of it.
//
// The set that was stored last is what the parameters have after a start. A command stores the set that is held, or
// forgets what is stored; both only while there is no force and none may come at once (may_store()).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <protocol/reports.hpp>
#include <protocol/supervision.hpp>

namespace inkwell::protocol {

// clang-format off
/// X(id, name, meaning, remedy)
#define INKWELL_STORE_RESULTS(X)                                                                                       \
  X(0, none, "No parameters have been stored or erased since the board started.", "Nothing to do.")                        \
  X(1, done, "The parameters are in flash and survive a power loss.", "Nothing to do.")                                          \
  X(2, under_way, "The parameters are being written. Writing waits while the force is on.", "Ask again after some milliseconds. If the force is on, switch it off.") \
  X(3, force_is_on, "Refused: the force is on, or a waiting command switches it on.", "Switch the force off, wait until a running test has ended, then try again.") \
  X(4, no_room, "Refused: the flash sector is full. The next start of the board frees space.", "Switch the board off and on, or reset it. Then set the values again and store them.") \
  X(5, flash_failed, "A flash word could not be written. The previously stored parameters are still valid.", "Reset the board and try again. If the error returns, replace the chip: its flash is worn.") \
  X(6, nothing_stored, "No parameters were stored, so nothing was erased. Every parameter has its default.", "Nothing to do.")

/// X(id, name, meaning)
#define INKWELL_STORE_CONTENTS(X)                                                                                      \
  X(0, nothing, "No parameters are stored, or they cannot be read. The next start sets every parameter to its default.")  \
  X(1, parameters, "Stored parameters, which the next start loads.")                                                        \
  X(2, factory_reset, "A factory reset erased the stored parameters. The next start sets every parameter to its default.")     \
  X(3, other_schema, "The records were written by a firmware with another schema and cannot be read. The next start sets every parameter to its default.")
// clang-format on

/// What became of the last command to store or to forget.
enum class StoreResult : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_STORE_RESULTS(X)
#undef X
};

/// What the newest whole record of the flash is.
enum class StoreContents : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_STORE_CONTENTS(X)
#undef X
};

struct StoreResultInfo {
  std::string_view name;
  std::string_view meaning;
  std::string_view remedy;
};

struct StoreContentsInfo {
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto store_result_table = std::to_array<StoreResultInfo>({
#define X(id, name, meaning, remedy) {#name, meaning, remedy},
    INKWELL_STORE_RESULTS(X)
#undef X
});

inline constexpr auto store_contents_table = std::to_array<StoreContentsInfo>({
#define X(id, name, meaning) {#name, meaning},
    INKWELL_STORE_CONTENTS(X)
#undef X
});

inline constexpr StoreResultInfo unknown_store_result{"unknown",
                                                      "The device reported a result that this companion does not know.",
                                                      "Use the companion of the firmware's version."};
inline constexpr StoreContentsInfo unknown_store_contents{
    "unknown", "The device reported stored contents that this companion does not know."};

constexpr const StoreResultInfo& info(StoreResult result) {
  const auto index = static_cast<std::size_t>(result);
  return index < store_result_table.size() ? store_result_table[index] : unknown_store_result;
}
constexpr const StoreContentsInfo& info(StoreContents contents) {
  const auto index = static_cast<std::size_t>(contents);
  return index < store_contents_table.size() ? store_contents_table[index] : unknown_store_contents;
}

namespace detail {
#define X(id, text, ...) \
  static_assert(store_result_table[id].name == std::string_view(#text), #text ": its id is not its place");
INKWELL_STORE_RESULTS(X)
#undef X
#define X(id, text, ...) \
  static_assert(store_contents_table[id].name == std::string_view(#text), #text ": its id is not its place");
INKWELL_STORE_CONTENTS(X)
#undef X
}  // namespace detail

/// Whether the board may be told to store or to forget: there is no force, and none comes without a further command.
constexpr bool may_store(State state) {
  return state == State::unreferenced || state == State::ready || state == State::fault;
}

/// How records are laid out; a firmware reads those of its own schema.
inline constexpr std::uint16_t store_schema = 1;
/// The sectors of the flash between which the records go to and fro.
inline constexpr std::size_t store_sectors = 2;
/// As many ids of entries that the firmware does not know are told.
inline constexpr std::size_t store_unknown_ids_maximum = 16;

/// Feature report: the state of the store.
struct StoreReport {
  ReportId report_id = ReportId::store;
  StoreResult result;               ///< of the last command to store or to forget
  StoreContents contents;           ///< now
  StoreContents contents_at_start;  ///< what this start found
  std::uint16_t differing;          ///< parameters that do not hold what the next start would give them
  std::uint16_t stores_left;        ///< how many more fit before the next start, which makes room
  std::uint32_t commands;           ///< to store or to forget, received since the start, refused ones included
  std::uint32_t records_written;    ///< in the board's life
  std::uint32_t sector_erases[store_sectors];  ///< in the board's life
  std::uint8_t firmware_version[4];            ///< that wrote what this start found: major, minor, patch, 0
  std::uint32_t parameter_table_hash;          ///< of that firmware
  std::uint32_t force_law_hash;                ///< of that firmware's force law's name; force_law_name_hash()
  std::uint16_t schema;                        ///< of what this start found; 0 for nothing
  std::uint16_t entries;                       ///< parameters in what this start found
  std::uint16_t out_of_range;  ///< of them those that took their default, because this firmware refuses their value
  std::uint16_t unknown;       ///< of them those that this firmware does not know; kept but for another force law's
  std::uint16_t unknown_ids[store_unknown_ids_maximum];  ///< the first of them, else 0
};

static_assert(sizeof(StoreReport) == 76);

/// FNV-1a of a force law's name; 0 is no law's.
constexpr std::uint32_t force_law_name_hash(std::string_view name) { return detail::fnv1a(2166136261u, name); }

}  // namespace inkwell::protocol
