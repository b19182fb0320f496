// The black box: what a board kept of the time around a fault. It keeps one, over a reset as well, from the fault until
// the force is switched on again or the power goes. Rows lie a millisecond apart; one is the fault's own.
//
//   host <- device   feature report  BlackBoxReport: whether there is one, and what it says
//   host -> device   feature report  BlackBoxRequest: the first row of the next BlackBoxRowsReport
//   host <- device   feature report  BlackBoxRowsReport, the same again until another one is asked for
#pragma once

#include <cstddef>
#include <cstdint>

#include <protocol/reports.hpp>
#include <protocol/request_result.hpp>
#include <protocol/signals.hpp>

namespace inkwell::protocol {

/// Control periods from one row to the next. The fault's own row is out of step with those before it.
inline constexpr std::uint32_t black_box_step_periods = servo_rate_Hz / 1000;
/// Rows before the fault, 100 ms of them, and from it on.
inline constexpr std::size_t black_box_rows_before = 100, black_box_rows_from_fault = 101;
inline constexpr std::size_t black_box_rows_maximum = black_box_rows_before + black_box_rows_from_fault;

/// The exceptions by which a crash record tells of a crystal that stopped (NMI) and of a main loop that hung (PendSV).
inline constexpr std::uint32_t crystal_exception = 2, hang_exception = 14;

/// What was noted as the processor crashed (ARMv7-M, "Fault handling") or the main loop hung; all 0 if neither.
struct CrashFacts {
  std::uint32_t exception;        ///< its number: one of those two, 3 to 6 a fault, from 16 on an unexpected interrupt
  std::uint32_t program_counter;  ///< of what follows, only r4 to r11 hold if the stack could not be read
  std::uint32_t link_register;
  std::uint32_t program_status;             ///< xPSR
  std::uint32_t stack_pointer;              ///< before the exception; 0 if the stack could not be read
  std::uint32_t registers[13];              ///< r0 to r12
  std::uint32_t configurable_fault_status;  ///< CFSR
  std::uint32_t hard_fault_status;          ///< HFSR
  std::uint32_t fault_address;              ///< MMFAR or BFAR, if CFSR says that it holds
  /// What the link register and the stack hold that lies behind a call, the newest first: where the calls came from,
  /// and perhaps some of older ones. 0 from the end on.
  std::uint32_t callers[8];
  std::uint32_t image_check;  ///< of the image that ran: the word that its ELF has in .image_check
};

/// Feature report, get.
struct BlackBoxReport {
  ReportId report_id = ReportId::black_box;
  std::uint8_t is_complete;     ///< 1: nothing more will come; 0: rows are still being added
  std::uint8_t is_restart;      ///< 1: the board's time ended with the last row; the start after it told the fault
  Fault fault;                  ///< `none` if no black box is kept; then the rest is 0
  std::uint16_t rows_before;    ///< how many of the rows are from before the fault; the first ones
  std::uint16_t row_count;      ///< up to black_box_rows_maximum
  std::uint32_t fault_periods;  ///< the control period of the fault, or of the last row before a restart
  /// Restarts after a crash since then; the signals stay those around the first fault.
  std::uint32_t later_crashes;
  CrashFacts crash;  ///< of the newest restart after a crash
};

/// Feature report, set. BlackBoxRowsReport::result is its result.
struct BlackBoxRequest {
  ReportId report_id = ReportId::black_box_rows;
  std::uint8_t version = protocol_version;
  std::uint16_t first_row;
};

/// Every signal of one control period, in the table's order; those of the force law behind them, as far as it has any.
struct BlackBoxRow {
  std::uint32_t time_periods;
  float values[signal_count + force_law_signals_maximum];
};

/// As many as have room where a device composes its answers.
inline constexpr std::size_t black_box_report_rows = (sizeof(ParametersReport) - 8) / sizeof(BlackBoxRow);

/// Feature report, get: some rows in the order of time.
struct BlackBoxRowsReport {
  ReportId report_id = ReportId::black_box_rows;
  std::uint8_t row_count : 4;  ///< 0..black_box_report_rows; 0 after the last row
  std::uint8_t result : 4;     ///< RequestResult of the last request: accepted, also before the first one, or malformed
  std::uint16_t first_row;     ///< of the last request that was accepted
  std::uint32_t fault_periods;  ///< BlackBoxReport::fault_periods, which tells one black box from another
  BlackBoxRow rows[black_box_report_rows];
};

static_assert(sizeof(CrashFacts) == 120 && sizeof(BlackBoxReport) == 136);
static_assert(sizeof(BlackBoxRequest) == 4);
static_assert(sizeof(BlackBoxRow) == 4 + 4 * (signal_count + force_law_signals_maximum));
static_assert(black_box_report_rows < 16 && request_result_table.size() <= 16, "both share a byte");
static_assert(sizeof(BlackBoxRowsReport) == 8 + black_box_report_rows * sizeof(BlackBoxRow) &&
              sizeof(BlackBoxRowsReport) <= sizeof(ParametersReport));

}  // namespace inkwell::protocol
