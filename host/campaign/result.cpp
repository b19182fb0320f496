#include <campaign/result.hpp>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/error.hpp>
#include <recording/gnuplot.hpp>

namespace inkwell::campaign {
namespace {

using nlohmann::ordered_json;

ordered_json optional(const std::optional<double>& value) { return value ? ordered_json(*value) : ordered_json(); }

std::optional<double> optional_number(const ordered_json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

}  // namespace

std::string to_json(const Result& r) {
  return ordered_json{{"number", r.number},
                      {"fault", r.fault},
                      {"situation", r.situation},
                      {"phase", r.phase},
                      {"error", r.error},
                      {"injected_at_s", r.injected_at_s},
                      {"place", r.place},
                      {"bridges_were_on", r.bridges_were_on},
                      {"off_after_s", optional(r.off_after_s)},
                      {"bridges_went_on", r.bridges_went_on},
                      {"detected_as", r.detected_as},
                      {"fault_on_healing", r.fault_on_healing},
                      {"restarts", r.restarts},
                      {"locked_up", r.locked_up},
                      {"force_limit_N", r.force_limit_N},
                      {"peak_force_N", r.peak_force_N},
                      {"energy_J", r.energy_J},
                      {"travel_m", r.travel_m},
                      {"recovery", r.recovery},
                      {"position_error_m", optional(r.position_error_m)}}
             .dump(2) +
         "\n";
}

Result from_json(const std::string& text) {
  try {
    const auto json = ordered_json::parse(text);
    Result r;
    json.at("number").get_to(r.number);
    json.at("fault").get_to(r.fault);
    json.at("situation").get_to(r.situation);
    json.at("phase").get_to(r.phase);
    json.at("error").get_to(r.error);
    json.at("injected_at_s").get_to(r.injected_at_s);
    json.at("place").get_to(r.place);
    json.at("bridges_were_on").get_to(r.bridges_were_on);
    r.off_after_s = optional_number(json.at("off_after_s"));
    json.at("bridges_went_on").get_to(r.bridges_went_on);
    json.at("detected_as").get_to(r.detected_as);
    json.at("fault_on_healing").get_to(r.fault_on_healing);
    json.at("restarts").get_to(r.restarts);
    json.at("locked_up").get_to(r.locked_up);
    json.at("force_limit_N").get_to(r.force_limit_N);
    json.at("peak_force_N").get_to(r.peak_force_N);
    json.at("energy_J").get_to(r.energy_J);
    json.at("travel_m").get_to(r.travel_m);
    json.at("recovery").get_to(r.recovery);
    r.position_error_m = optional_number(json.at("position_error_m"));
    return r;
  } catch (const nlohmann::json::exception& error) {
    throw device::Error(fmt::format("This is no result of a case: {}. Run the case again.", error.what()));
  }
}

std::filesystem::path file_of(const std::filesystem::path& directory, unsigned number) {
  return directory / fmt::format("case-{:05}.json", number);
}

void save(const Result& result, const std::filesystem::path& directory) {
  const auto file = file_of(directory, result.number);
  // Several programs may write into the folder, of several machines if it is shared.
  auto unfinished = file;
  unfinished += fmt::format(".{}.part", ::getpid());
  recording::write_text(unfinished, to_json(result));
  std::error_code code;
  std::filesystem::rename(unfinished, file, code);
  if (code) throw device::Error(fmt::format("{} cannot be written: {}", file.string(), code.message()));
}

std::vector<Result> load_all(const std::filesystem::path& directory) {
  std::error_code code;
  std::vector<Result> results;
  for (const auto& entry : std::filesystem::directory_iterator(directory, code)) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    try {
      results.push_back(from_json(text));
    } catch (const device::Error& error) {
      throw device::Error(fmt::format("{}: {}", entry.path().string(), error.what()));
    }
  }
  if (code) throw device::Error(fmt::format("The folder {} cannot be read: {}", directory.string(), code.message()));
  std::ranges::sort(results, {}, &Result::number);
  return results;
}

}  // namespace inkwell::campaign
