#include "host/lab/soak/result.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace inkwell::soak {

namespace {

/// Returns the counts in alphabetical order.
template <class Of>
std::map<std::string, unsigned> by_name(const std::map<Of, unsigned>& counts) {
  std::map<std::string, unsigned> named;
  for (const auto& [of, count] : counts) named[std::string(protocol::info(of).name)] += count;
  return named;
}

}  // namespace

// Only written. JSON contains the names of faults, kinds and complaints.
static void to_json(nlohmann::json& out, Kind kind) { out = info(kind).name; }
static void to_json(nlohmann::json& out, Complaint complaint) { out = name_of(complaint); }
static void to_json(nlohmann::json& out, const Finding& of) {
  out = {{"phase", of.phase},
         {"kind", of.kind},
         {"board_time_s", of.board_time_s},
         {"complaint", of.complaint},
         {"text", of.text}};
}
static void to_json(nlohmann::json& out, const Press& of) {
  out = {{"force_N", of.force_N},
         {"limit_N", of.limit_N},
         {"phase", of.phase},
         {"kind", of.kind},
         {"board_time_s", of.board_time_s}};
}
static void to_json(nlohmann::json& out, const PhaseResult& of) {
  out = {{"number", of.number},
         {"kind", of.kind},
         {"begin_s", of.begin_s},
         {"duration_s", of.duration_s},
         {"what", of.what}};
}
static void to_json(nlohmann::json& out, const Losses& of) {
  out = {{"poses", of.poses},
         {"poses_kept_back", of.poses_kept_back},
         {"scope_samples", of.scope_samples},
         {"wide_scope_samples", of.wide_scope_samples},
         {"program_forces", of.program_forces},
         {"recorded_samples", of.recorded_samples}};
}
static void to_json(nlohmann::json& out, const Sitting& of) {
  out = {{"number", of.number},
         {"board_time_s", of.board_time_s},
         {"phases", of.phases},
         {"findings", of.findings},
         {"faults_put_in", by_name(of.faults_put_in)},
         {"faults_told", by_name(of.faults_told)},
         {"restarts", of.restarts},
         {"peak_motor_force_N", of.peak_motor_force_N},
         {"hardest_press", of.hardest_press},
         {"hardest_press_with_fault", of.hardest_press_with_fault},
         {"hardest_press_with_fault_over_ms", of.hardest_press_with_fault_over_ms},
         {"longest_interrupt_part", of.longest_interrupt_part},
         {"transactions", of.transactions},
         {"refused_transactions", of.refused_transactions},
         {"poses", of.poses},
         {"lost", of.lost}};
}
static void to_json(nlohmann::json& out, const Soak& of) {
  out = {{"seed", of.seed},
         {"sitting_s", of.sitting_s},
         {"use_s", of.use_s},
         {"stopped", of.stopped},
         {"sittings", of.sittings}};
}

namespace {

template <class Value, class Of>
Value sum(const Soak& soak, Of of) {
  return std::accumulate(soak.sittings.begin(), soak.sittings.end(), Value{},
                         [&](Value so_far, const Sitting& sitting) { return so_far + of(sitting); });
}

template <class Of>
double largest(const Soak& soak, Of of) {
  double most = 0;
  for (const Sitting& sitting : soak.sittings) most = std::max(most, static_cast<double>(of(sitting)));
  return most;
}

std::string row(std::string_view what, const std::string& figure) {
  return fmt::format("  {:<42}{:>12}\n", what, figure);
}

/// Returns the table rows about the largest force.
std::string rows_of_press(const Soak& soak, Press Sitting::*which, std::string_view what) {
  const auto part_of_limit = [&](const Sitting& sitting) { return (sitting.*which).part_of_limit(); };
  const auto hardest = std::ranges::max_element(soak.sittings, {}, part_of_limit);
  if (hardest == soak.sittings.end() || part_of_limit(*hardest) == 0) return row(what, "-");
  const Press& press = (*hardest).*which;
  return row(what, fmt::format("{:.3f}", press.part_of_limit())) +
         fmt::format("    {:.2f} of {:.2f} N in {}.{} ({}) at {:.3f} s\n", press.force_N, press.limit_N,
                     hardest->number, press.phase, info(press.kind).name, press.board_time_s);
}

template <class Which>
std::string counts_of(const Soak& soak, Which which) {
  std::map<std::string, unsigned> counts;
  for (const Sitting& sitting : soak.sittings)
    for (const auto& [name, count] : by_name(which(sitting))) counts[name] += count;
  std::string text;
  for (const auto& [name, count] : counts) text += row("  " + name, std::to_string(count));
  return text;
}

template <class Of>
unsigned total(const std::map<Of, unsigned>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0u,
                         [](unsigned sum, const auto& one) { return sum + one.second; });
}

std::string kinds_of(const Soak& soak) {
  std::string text;
  for (std::size_t i = 0; i < kind_table.size(); ++i) {
    unsigned phases = 0;
    double time_s = 0;
    for (const Sitting& sitting : soak.sittings)
      for (const PhaseResult& phase : sitting.phases)
        if (phase.kind == static_cast<Kind>(i)) {
          ++phases;
          time_s += phase.duration_s;
        }
    text += row(fmt::format("  {}", kind_table[i].name), fmt::format("{} ({:.0f} s)", phases, time_s));
  }
  return text;
}

}  // namespace

std::size_t finding_count(const Soak& soak) {
  return sum<std::size_t>(soak, [](const Sitting& sitting) { return sitting.findings.size(); });
}

unsigned false_trip_count(const Soak& soak) {
  return sum<unsigned>(soak, [](const Sitting& sitting) {
    return static_cast<unsigned>(std::ranges::count(sitting.findings, Complaint::false_trip, &Finding::complaint));
  });
}

std::string line_of(const Sitting& sitting, const PhaseResult& phase) {
  return fmt::format("{}.{:<4} {:9.3f} s {:7.3f} s  {:<11} {}\n", sitting.number, phase.number, phase.begin_s,
                     phase.duration_s, info(phase.kind).name, phase.what);
}

std::string repeat_command(const Soak& soak, unsigned sitting) {
  return fmt::format("inkwell-lab soak --seed {} --sitting {} --sitting-seconds {} --use-seconds {}", soak.seed,
                     sitting, soak.sitting_s, soak.use_s);
}

std::string table_of(const Soak& soak) {
  std::string text = fmt::format("\nSimulation: {} boards, seed {}{}\n", soak.sittings.size(), soak.seed,
                                 soak.stopped ? ", stopped early" : "");
  text += row("board time, all boards together",
              fmt::format("{:.1f} s", sum<double>(soak, [](const auto& s) { return s.board_time_s; })));
  text += row("phases", std::to_string(sum<std::size_t>(soak, [](const auto& s) { return s.phases.size(); }))) +
          kinds_of(soak);
  text +=
      row("injected faults", std::to_string(sum<unsigned>(soak, [](const auto& s) { return total(s.faults_put_in); })));
  text +=
      row("reported faults", std::to_string(sum<unsigned>(soak, [](const auto& s) { return total(s.faults_told); }))) +
      counts_of(
          soak, [](const Sitting& s) -> const auto& { return s.faults_told; });
  text += row("false trips", std::to_string(false_trip_count(soak)));
  text += row("restarts (intended, or due to faults)",
              std::to_string(sum<unsigned>(soak, [](const auto& s) { return s.restarts; })));
  text += row("transactions of parameters",
              std::to_string(sum<unsigned long>(soak, [](const auto& s) { return s.transactions; })));
  text += row("  illegal transactions, all refused",
              std::to_string(sum<unsigned long>(soak, [](const auto& s) { return s.refused_transactions; })));
  text += row("peak force of the motors",
              fmt::format("{:.2f} N", largest(soak, [](const auto& s) { return s.peak_motor_force_N; })));
  text += rows_of_press(soak, &Sitting::hardest_press,
                        fmt::format("  relative to a limit of {} N or more", Oracle::judged_limit_N));
  text += rows_of_press(soak, &Sitting::hardest_press_with_fault, "  the same with an injected fault");
  text += rows_of_press(soak, &Sitting::hardest_press_with_fault_over_ms, "  the same, mean over a millisecond");
  text += row("longest interrupt as a part of its period",
              fmt::format("{:.0f} %", 100 * largest(soak, [](const auto& s) { return s.longest_interrupt_part; })));
  const auto lost = [&](auto which) {
    return std::to_string(sum<unsigned long>(soak, [&](const auto& s) { return s.lost.*which; }));
  };
  text += row("poses read", std::to_string(sum<unsigned long>(soak, [](const auto& s) { return s.poses; })));
  text += row("  lost", lost(&Losses::poses));
  text += row("  missing due to injected faults", lost(&Losses::poses_kept_back));
  text += row("samples of the scope lost", lost(&Losses::scope_samples));
  text += row("  of selections above the bus capacity", lost(&Losses::wide_scope_samples));
  text += row("samples of recordings lost", lost(&Losses::recorded_samples));
  text += row("forces of programs lost", lost(&Losses::program_forces));
  text += row("findings", std::to_string(finding_count(soak)));
  for (const Sitting& sitting : soak.sittings)
    for (const Finding& finding : sitting.findings)
      text += fmt::format("  {} in phase {} ({}) at {:.3f} s: {}\n    again: {}\n", name_of(finding.complaint),
                          finding.phase, info(finding.kind).name, finding.board_time_s, finding.text,
                          repeat_command(soak, sitting.number));
  return text;
}

std::string json_of(const Soak& soak) {
  nlohmann::json json = soak;
  json["findings"] = finding_count(soak);
  json["false_trips"] = false_trip_count(soak);
  return json.dump(1) + "\n";
}

}  // namespace inkwell::soak
