// Record of the signals around a fault (black box). The board retains one black box until the force is switched on or
// the power is lost. Rows are 1 ms apart. One row shows the control period of the fault.
//
//   BlackBoxReport (device to host): presence, fault and crash data.
//   BlackBoxRequest (host to device): first row of the next BlackBoxRowsReport.
//   BlackBoxRowsReport (device to host): the requested rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "protocol/reports.hpp"
#include "protocol/request_result.hpp"
#include "protocol/signals.hpp"

namespace inkwell::protocol {

/// Number of control periods between consecutive rows, except before the row of the fault.
inline constexpr std::uint32_t black_box_step_periods = servo_rate_Hz / 1000;
/// The black box has 100 rows before the fault and 101 rows from the fault on.
inline constexpr std::size_t black_box_rows_before = 100, black_box_rows_from_fault = 101;
inline constexpr std::size_t black_box_rows_maximum = black_box_rows_before + black_box_rows_from_fault;

/// Exception numbers of a failed crystal (NMI) and a stalled main loop (PendSV).
inline constexpr std::uint32_t crystal_exception = 2, hang_exception = 14;

/// Crash record of a CPU fault (ARMv7-M, "Fault handling") or a stalled main loop. All values are 0 if there is no
/// crash record.
struct CrashFacts {
  /// Exception number: crystal_exception, hang_exception, 3 to 6 for a CPU fault, 16 or more for an unexpected
  /// interrupt.
  std::uint32_t exception;
  /// If the stack could not be read, only r4 to r11 are valid in the fields `program_counter` to `registers`.
  std::uint32_t program_counter;
  std::uint32_t link_register;
  std::uint32_t program_status;             ///< xPSR
  std::uint32_t stack_pointer;              ///< value before the exception; 0 if the stack could not be read
  std::uint32_t registers[13];              ///< r0 to r12
  std::uint32_t configurable_fault_status;  ///< CFSR
  std::uint32_t hard_fault_status;          ///< HFSR
  std::uint32_t fault_address;              ///< MMFAR or BFAR, if CFSR marks it as valid
  /// Return addresses from the link register and the stack, newest first. Some addresses may belong to earlier calls.
  /// Unused entries are 0.
  std::uint32_t callers[8];
  std::uint32_t image_check;  ///< checksum of the image that ran: the word in section .image_check of its ELF
};

/// Feature report, get.
struct BlackBoxReport {
  ReportId report_id = ReportId::black_box;
  std::uint8_t is_complete;     ///< 1: the record is complete; 0: rows are still being added
  std::uint8_t is_restart;      ///< 1: the board restarted after the last row, and the fault was found at that start
  Fault fault;                  ///< `none` if there is no black box; then all further fields are 0
  std::uint16_t rows_before;    ///< number of rows before the fault; these rows come first
  std::uint16_t row_count;      ///< 0..black_box_rows_maximum
  std::uint32_t fault_periods;  ///< control period of the fault, or of the last row before a restart
  /// Number of crash restarts since the fault. Later crashes do not change the rows.
  std::uint32_t later_crashes;
  CrashFacts crash;  ///< crash record of the newest restart after a crash
};

/// Feature report, set. BlackBoxRowsReport::result is the result of the request.
struct BlackBoxRequest {
  ReportId report_id = ReportId::black_box_rows;
  std::uint8_t version = protocol_version;
  std::uint16_t first_row;
};

/// Table signals of one control period in table order, followed by the signals of the force law.
struct BlackBoxRow {
  std::uint32_t time_periods;
  float values[signal_count + force_law_signals_maximum];
};

/// Largest number of rows in a BlackBoxRowsReport.
inline constexpr std::size_t black_box_report_rows = (sizeof(ParametersReport) - 8) / sizeof(BlackBoxRow);

/// Feature report, get. Consecutive rows in time order.
struct BlackBoxRowsReport {
  ReportId report_id = ReportId::black_box_rows;
  std::uint8_t row_count : 4;  ///< 0..black_box_report_rows; 0 after the last row
  /// RequestResult of the last request: `accepted` (also before the first request) or `malformed`.
  std::uint8_t result : 4;
  std::uint16_t first_row;      ///< first row of the last accepted request
  std::uint32_t fault_periods;  ///< BlackBoxReport::fault_periods, which identifies the black box
  BlackBoxRow rows[black_box_report_rows];
};

static_assert(sizeof(CrashFacts) == 120 && sizeof(BlackBoxReport) == 136);
static_assert(sizeof(BlackBoxRequest) == 4);
static_assert(sizeof(BlackBoxRow) == 4 + 4 * (signal_count + force_law_signals_maximum));
static_assert(black_box_report_rows < 16 && request_result_table.size() <= 16, "both share a byte");
static_assert(sizeof(BlackBoxRowsReport) == 8 + black_box_report_rows * sizeof(BlackBoxRow) &&
              sizeof(BlackBoxRowsReport) <= sizeof(ParametersReport));

}  // namespace inkwell::protocol
