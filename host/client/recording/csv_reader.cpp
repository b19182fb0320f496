#include "host/client/recording/formats.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "host/client/local/text_file.hpp"

namespace inkwell::recording {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns std::nullopt if the text is not a whole number or if the number is out of range.
template <class Whole>
std::optional<Whole> whole_number(std::string_view text) {
  Whole value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns std::nullopt for times that no board can reach.
std::optional<std::int64_t> period_at(double time_s) {
  constexpr double convertible = 1e18;
  const double periods = time_s * protocol::servo_rate_Hz;
  if (!(periods >= 0.0 && periods < convertible)) return std::nullopt;
  const std::int64_t period = std::llround(periods);
  return can_be_period(period) ? std::optional(period) : std::nullopt;
}

class CsvReader {
 public:
  CsvReader(std::istream& stream, const std::string& name) : name_(name), stream_(stream) {
    recording_.complete = false;
  }

  Recording read() {
    std::string text;
    while (std::getline(stream_, text)) {
      ++line_number_;
      // If the program was killed, the last line may be incomplete. An incomplete line is ignored.
      if (stream_.eof()) break;
      std::string_view line = local::without_carriage_return(text);
      if (line_number_ == 1) line = local::without_byte_order_mark(line);
      if (line.empty()) continue;
      if (line.starts_with("# "))
        comment(line.substr(2));
      else if (!columns_known_)
        column_names(line);
      else
        sample(line);
    }
    if (!is_recording_) fail(fmt::format("does not start with \"# {}\", so it is not a recording", format_name));
    if (!columns_known_) fail("has no line of column names");
    return std::move(recording_);
  }

 private:
  enum class Holds : std::uint8_t { signal, simulated, unknown };

  void comment(std::string_view text) {
    const auto equals = text.find(" = ");
    const auto key = text.substr(0, equals);
    const auto value = equals == text.npos ? std::string_view{} : text.substr(equals + 3);
    auto& about = recording_.information;
    if (key == format_name) {
      is_recording_ = true;
      if (number(value).value_or(0) > format_version)
        recording_.remarks.push_back(fmt::format("{} was written by a newer version of this program.", name_));
    } else if (std::string* const known = text_of(key))
      *known = value;
    else if (key == "protocol_version")
      about.protocol_version = whole_number<std::uint16_t>(value).value_or(0);
    else if (key == "simulation")
      about.simulation = value == "1";
    else if (key == "step_periods")
      about.step_periods = step_periods_of(number(value).value_or(1));
    else if (key == "force_law")
      take_force_law(recording_, value, name_);
    else if (key == "complete")
      recording_.complete = value == "1";
    else if (key.starts_with("mark "))
      mark(key.substr(5), value);
    else if (key.starts_with("clock "))
      clock(key.substr(6), value);
    else if (key.starts_with("parameter "))
      parameter(key.substr(10), value);
  }
  /// Returns the text with this name; null if there is none.
  std::string* text_of(std::string_view key) {
    auto& about = recording_.information;
    const std::pair<std::string_view, std::string*> texts[] = {{"name", &about.name},
                                                               {"note", &about.note},
                                                               {"created_utc", &about.created_utc},
                                                               {"library_version", &about.library_version},
                                                               {"library_sha256", &about.library_sha256},
                                                               {"image_sha256", &about.image_sha256},
                                                               {"arm_sha256", &about.arm_sha256},
                                                               {"firmware_version", &about.firmware_version},
                                                               {"serial_number", &about.serial_number},
                                                               {"arm", &about.arm}};
    const auto found = std::ranges::find(texts, key, &std::pair<std::string_view, std::string*>::first);
    return found == std::end(texts) ? nullptr : found->second;
  }
  void clock(std::string_view period_text, std::string_view time_text) {
    const auto period = whole_number<std::int64_t>(period_text), time_us = whole_number<std::int64_t>(time_text);
    if (period && time_us && can_be_period(*period)) recording_.clock.push_back({*period, *time_us});
  }
  /// `about`: "PERIOD" or "PERIOD KIND CLOCK".
  void mark(std::string_view about, std::string_view text) {
    const auto next = [&about] {
      const auto word = about.substr(0, about.find(' '));
      about.remove_prefix(std::min(about.size(), word.size() + 1));
      return word;
    };
    const auto period = whole_number<std::int64_t>(next());
    const auto kind = device::find_event_kind(next()).value_or(device::EventKind::mark);
    if (period && can_be_period(*period))
      recording_.marks.push_back({*period, std::string(text), kind, std::string(next())});
    else
      recording_.remarks.push_back(fmt::format("The mark \"{}\" of {} has no period and was ignored.", text, name_));
  }
  void parameter(std::string_view name, std::string_view text) {
    const auto known = protocol::find_parameter(name);
    const auto value = number(text);
    if (known && value)
      recording_.information.parameters[*known] = static_cast<float>(*value);
    else
      recording_.remarks.push_back(
          fmt::format("The parameter {} of {} is unknown to this version and was ignored.", name, name_));
  }
  void column_names(std::string_view line) {
    columns_known_ = true;
    if (!line.starts_with("time_s")) fail("does not have time_s as its first column");
    for (line.remove_prefix(6); !line.empty();) {
      line.remove_prefix(1);
      const auto name = line.substr(0, line.find(','));
      auto& about = recording_.information;
      if (const auto signal = protocol::find_signal(name)) {
        about.signals.push_back(*signal);
        holds_.push_back(Holds::signal);
      } else if (const auto simulated = protocol::find_simulated_quantity(name)) {
        about.simulated.push_back(*simulated);
        holds_.push_back(Holds::simulated);
      } else {
        recording_.remarks.push_back(
            fmt::format("The signal {} of {} is unknown to this version and was ignored.", name, name_));
        holds_.push_back(Holds::unknown);
      }
      line.remove_prefix(name.size());
    }
    recording_.columns.resize(recording_.information.signals.size());
    recording_.simulated_columns.resize(recording_.information.simulated.size());
  }
  void sample(std::string_view line) {
    const auto next = [&]() -> double {
      const auto cell = line.substr(0, line.find(','));
      const auto value = number(cell);
      if (!value) fail(fmt::format("is damaged in line {}: \"{}\" is not a number", line_number_, cell));
      line.remove_prefix(std::min(line.size(), cell.size() + 1));
      return *value;
    };
    const double time_s = next();
    const auto period = period_at(time_s);
    if (!period) fail(fmt::format("is damaged in line {}: {} s is not a valid board time", line_number_, time_s));
    recording_.periods.push_back(recording_.size() == 0 ? *period : period_after(recording_.periods.back(), *period));
    auto column = recording_.columns.begin(), simulated_column = recording_.simulated_columns.begin();
    for (const Holds holds : holds_) {
      const auto value = static_cast<float>(next());
      if (holds == Holds::signal) (column++)->push_back(value);
      if (holds == Holds::simulated) (simulated_column++)->push_back(value);
    }
    if (!line.empty()) fail(fmt::format("is damaged in line {}: it has more values than columns", line_number_));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw device::Error(fmt::format("{} {}. Nothing was loaded.", name_, what));
  }

  std::string name_;
  std::istream& stream_;
  Recording recording_;
  std::vector<Holds> holds_;  ///< for each column after the time
  std::size_t line_number_ = 0;
  bool is_recording_ = false;
  bool columns_known_ = false;
};

}  // namespace

Recording read_csv(std::istream& stream, const std::string& name) { return CsvReader(stream, name).read(); }

}  // namespace inkwell::recording
