#include "host/client/device/control_answers.hpp"

#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "host/client/device/plain_json.hpp"

namespace inkwell::device {
namespace {

using nlohmann::json;

/// Calls `read`. Throws Error with `sentence` if a JSON value has the wrong type.
template <class Read>
auto read_or_fail(const char* sentence, Read read) {
  try {
    return read();
  } catch (const json::exception&) {
    throw Error(sentence);
  }
}

constexpr char damaged_answer[] = "The virtual board sent a damaged answer. Build the virtual board again.";

/// Checks type and range, because nlohmann::json converts without these checks.
template <class Whole>
Whole whole_number(const json& value, const char* sentence) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<Whole>::max())
    throw Error(sentence);
  return value.get<Whole>();
}

Injection injection_in(const json& entry, const char* time_key, const char* sentence) {
  Injection injection{.number = whole_number<unsigned>(entry.at("number"), sentence),
                      .fault = entry.at("fault").get<std::string>(),
                      .of = entry.value("of", std::string()),
                      .at_s = entry.at(time_key).get<double>(),
                      .has_come = std::string_view(time_key) == "since_s"};
  if (entry.contains("amount")) injection.amount = entry["amount"].get<double>();
  if (entry.contains("until_s")) injection.until_s = entry["until_s"].get<double>();
  return injection;
}

}  // namespace

json parse_answer(std::string_view line, std::string_view command) {
  return read_or_fail(
      "The program at the control port is not a virtual board. Give the control port that virtual-board printed.", [&] {
        json answer = parse_plain_json(line);
        if (answer.at("ok").get<bool>()) return answer;
        throw CommandRefused(fmt::format("The virtual board refused \"{}\": {}", command,
                                         answer.value("error", std::string("no reason was given."))));
      });
}

BoardStatus status_of(json answer) {
  return read_or_fail(damaged_answer, [&] {
    BoardStatus status;
    status.board_time_s = answer.value("board_time_s", 0.0);
    status.mode = answer.value("mode", std::string());
    status.paused = answer.value("paused", false);
    status.locked_up = answer.value("locked_up", std::string());
    status.unmodelled = answer.value("unmodelled", std::vector<std::string>());
    status.all = std::move(answer);
    return status;
  });
}

PinLevels pin_levels_of(const json& answer) {
  return read_or_fail(damaged_answer, [&] {
    return PinLevels{answer.value("level", std::string()), answer.value("chip_drives", std::string())};
  });
}

Injection injection_of(const json& answer, const protocol::InjectionRequest& request) {
  return read_or_fail(damaged_answer, [&] {
    Injection injection{.number = whole_number<unsigned>(answer.value("number", json(0u)), damaged_answer),
                        .fault = request.fault,
                        .of = request.of,
                        .amount = request.amount,
                        .at_s = answer.value("at_s", 0.0),
                        .has_come = request.after_s == 0.0};
    if (request.for_s) injection.until_s = injection.at_s + *request.for_s;
    return injection;
  });
}

Injections injections_of(const json& status) {
  static constexpr char sentence[] =
      "The virtual board does not report its injected faults. Build the virtual board again.";
  return read_or_fail(sentence, [&] {
    const json& period = status.at("control_period");
    Injections now{.board_time_s = status.at("board_time_s").get<double>(),
                   .period = whole_number<std::uint64_t>(period.at("number"), sentence),
                   .period_at_s = period.at("board_time_s").get<double>(),
                   .faults = {}};
    for (const json& each : status.at("injected")) now.faults.push_back(injection_in(each, "since_s", sentence));
    for (const json& each : status.at("still_to_come")) now.faults.push_back(injection_in(each, "at_s", sentence));
    return now;
  });
}

MeterReading meter_reading_of(const json& answer) {
  return read_or_fail(damaged_answer, [&] {
    return MeterReading{answer.value("peak_force_N", 0.0),       answer.value("energy_J", 0.0),
                        answer.value("travel_m", 0.0),           answer.value("lag_m", 0.0),
                        answer.value("peak_motor_force_N", 0.0), answer.value("peak_motor_force_over_ms_N", 0.0)};
  });
}

Trace trace_of(const json& answer) {
  static constexpr char sentence[] = "The virtual board sent a damaged trace. Build the virtual board again.";
  return read_or_fail(sentence, [&] {
    Trace trace;
    trace.columns = answer.at("columns").get<std::vector<std::string>>();
    for (const auto& row : answer.at("rows")) {
      if (row.size() != trace.columns.size()) throw Error(sentence);
      for (const auto& value : row) trace.values.push_back(value.get<double>());
    }
    return trace;
  });
}

}  // namespace inkwell::device
