// Table of all HID reports and their sizes. The device generates its report descriptor from this table. `inkwell
// reference` prints the table.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/black_box.hpp"
#include "protocol/driver.hpp"
#include "protocol/reports.hpp"
#include "protocol/self_test.hpp"
#include "protocol/store.hpp"

namespace inkwell::protocol {

/// Values of the high byte of wValue (HID 1.11, section 7.2.1).
enum class ReportKind : std::uint8_t { input = 1, output = 2, feature = 3 };

// clang-format off
/// X(id, usage, kind, get, set, bytes, set_bytes, meaning). `get` and `set` are the structures for reading and writing,
/// or `none`. `bytes` is the declared size for both structures. `set_bytes` is the smallest size of a written report,
/// or 0.
#define INKWELL_REPORTS(X)                                                                                             \
  X(pose, 2, input, PoseReport, none, sizeof(PoseReport), 0, "The newest pose. The interrupt endpoint also sends it every millisecond.") \
  X(command, 3, output, none, CommandReport, sizeof(CommandReport), sizeof(CommandReport), "A command. The report is also a sign of life.") \
  X(force, 8, output, none, ForceReport, sizeof(ForceReport), sizeof(ForceReport), "The force of a program. The report is also a sign of life.") \
  X(local_model, 18, output, none, LocalModelReport, sizeof(LocalModelReport), sizeof(LocalModelReport), "A local model of the objects at the tip and the force of a program. The report is also a sign of life.") \
  X(information, 4, feature, InformationReport, none, sizeof(InformationReport), 0, "The identity of the device and its counters.") \
  X(parameters, 5, feature, ParametersReport, ParametersReport, sizeof(ParametersReport), parameters_report_size(0), "A read returns every parameter. A write changes parameters in one transaction.") \
  X(transaction, 6, feature, TransactionReport, none, sizeof(TransactionReport), 0, "The result of the last transaction.") \
  X(frame, 7, feature, FrameReport, none, sizeof(FrameReport), 0, "The start of the newest bus frame in board time.")   \
  X(shapes, 9, feature, none, ShapesReport, sizeof(ShapesReport), shapes_report_size(0), "The new shapes, which replace all previous shapes, and the materials of local models.") \
  X(force_law, 10, feature, ForceLawReport, none, force_law_report_maximum, 0, "The parameters and signals that the force law of the image adds to the tables. The report header contains the report size.") \
  X(black_box, 11, feature, BlackBoxReport, none, sizeof(BlackBoxReport), 0, "The state and the fault of the black box, and the crash record of the firmware.") \
  X(black_box_rows, 12, feature, BlackBoxRowsReport, BlackBoxRequest, sizeof(BlackBoxRowsReport), sizeof(BlackBoxRequest), "A read returns rows of the black box. A write selects the first row.") \
  X(self_test, 13, feature, SelfTestReport, none, sizeof(SelfTestReport), 0, "The results of the self-test.")          \
  X(store, 14, feature, StoreReport, none, sizeof(StoreReport), 0, "The contents of the parameter store, and the result of the last store or erase command.") \
  X(stored, 15, feature, ParametersReport, none, sizeof(ParametersReport), 0, "The value of every parameter after the next start.") \
  X(driver, 16, feature, DriverReport, ClaimReport, std::max(sizeof(DriverReport), sizeof(ClaimReport)), sizeof(ClaimReport), "A read returns the program that drives the arm. A write claims, releases or takes over the arm.") \
  X(request_results, 17, feature, RequestResultsReport, none, sizeof(RequestResultsReport), 0, "The results of the newest commands and shapes.")
// clang-format on

namespace detail {
constexpr bool names_structure(std::string_view name) { return name != "none"; }
}  // namespace detail

struct ReportInfo {
  ReportId id;
  std::uint8_t usage;  ///< in the report descriptor
  ReportKind kind;
  bool can_be_read;
  std::size_t bytes;              ///< declared in the report descriptor, including the id
  std::size_t set_bytes_minimum;  ///< 0 for a report that cannot be written

  constexpr bool can_be_set() const { return set_bytes_minimum != 0; }
};

inline constexpr auto report_table = std::to_array<ReportInfo>({
#define X(id, usage, kind, get, set, bytes, set_bytes, ...) \
  {ReportId::id, usage, ReportKind::kind, detail::names_structure(#get), bytes, set_bytes},
    INKWELL_REPORTS(X)
#undef X
});

/// Texts of a report. The texts are separate from report_table, because the device does not need them.
struct ReportText {
  std::string_view get, set;  ///< names of the structures, or `none`
  std::string_view meaning;
};

inline constexpr auto report_texts = std::to_array<ReportText>({
#define X(id, usage, kind, get, set, bytes, set_bytes, meaning) {#get, #set, meaning},
    INKWELL_REPORTS(X)
#undef X
});

/// Returns null for a report that is not in the table.
constexpr const ReportInfo* find_report(ReportKind kind, ReportId id) {
  for (const auto& row : report_table)
    if (row.kind == kind && row.id == id) return &row;
  return nullptr;
}

/// Returns the size of the longest report of a kind. hidapi on Windows pads every report to this size.
constexpr std::size_t longest_report(ReportKind kind) {
  std::size_t longest = 0;
  for (const auto& row : report_table)
    if (row.kind == kind) longest = std::max(longest, row.bytes);
  return longest;
}

/// Returns true if the device accepts a written report of `bytes` bytes. A written report may be padded.
constexpr bool is_accepted_length(const ReportInfo& row, std::size_t bytes) {
  return row.can_be_set() && bytes >= row.set_bytes_minimum && bytes <= longest_report(row.kind);
}

#define X(label, number, sort, get, set, ...)                                                                      \
  static_assert(find_report(ReportKind::sort, ReportId::label)->usage == (number), #label ": in the table twice"); \
  static_assert(find_report(ReportKind::sort, ReportId::label)->set_bytes_minimum <=                               \
                    find_report(ReportKind::sort, ReportId::label)->bytes,                                         \
                #label ": the used part is longer than the declared size");                                        \
  static_assert(find_report(ReportKind::sort, ReportId::label)->can_be_set() == detail::names_structure(#set),     \
                #label ": set_bytes must be 0 if and only if the report cannot be set");
INKWELL_REPORTS(X)
#undef X

}  // namespace inkwell::protocol
