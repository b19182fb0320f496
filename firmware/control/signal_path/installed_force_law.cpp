// Includes the force law file and adapts the force law to the firmware. Static assertions check the requirements on a
// force law.
#include "firmware/control/signal_path/installed_force_law.hpp"

#include <bit>
#include <concepts>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

// The build defines INKWELL_FORCE_LAW_FILE. The build also defines INKWELL_FORCE_LAW as the file name without suffix.
#include INKWELL_FORCE_LAW_FILE

namespace inkwell::force_laws {
struct INKWELL_FORCE_LAW;  // complete if the file defines it
}

namespace inkwell::control {

namespace {

// ---- requirements ----------------------------------------------------------------------------

template <class Law>
concept IsDefined = requires {
  sizeof(Law);
};

template <class Law>
concept HasParts = requires {
  typename Law::Parameters;
  typename Law::State;
  typename Law::Signals;
};

template <class Law>
concept HasHelp = requires {
  { Law::help } -> std::convertible_to<std::string_view>;
};

template <class Law>
concept HasFunction = HasParts<Law> && requires(const Probe& probe, const typename Law::Parameters& parameters,
                                                typename Law::State& state, typename Law::Signals& signals) {
  { Law::force_N(probe, parameters, state, signals) } -> std::same_as<Vector3>;
};

template <class Law>
concept HasSmallState = HasParts<Law> && std::is_trivially_copyable_v<typename Law::State> &&
                        std::is_default_constructible_v<typename Law::State> &&
                        sizeof(typename Law::State) <= ForceLawMemory::state_bytes;

/// Rows of the law, or an empty array.
template <class Law>
constexpr auto parameter_rows() {
  if constexpr (requires { std::span<const ForceParameter<typename Law::Parameters>>(Law::parameter_rows); })
    return std::span<const ForceParameter<typename Law::Parameters>>(Law::parameter_rows);
  else
    return std::array<ForceParameter<typename Law::Parameters>, 0>{};
}
template <class Law>
constexpr auto signal_rows() {
  if constexpr (requires { std::span<const ForceSignal<typename Law::Signals>>(Law::signal_rows); })
    return std::span<const ForceSignal<typename Law::Signals>>(Law::signal_rows);
  else
    return std::array<ForceSignal<typename Law::Signals>, 0>{};
}

/// Returns true if each struct member is a float and has one row.
template <class Values, class Rows>
constexpr bool fit_rows(const Rows& rows) {
  if constexpr (std::is_empty_v<Values>) {
    return rows.size() == 0;
  } else {
    if (sizeof(Values) != rows.size() * sizeof(float)) return false;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t other = 0; other < i; ++other)
        if (rows[i].value == rows[other].value) return false;
    return true;
  }
}

constexpr bool is_name(std::string_view name) {
  if (name.empty() || name.size() > 40) return false;
  for (const char c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_')) return false;
  return true;
}

template <class Rows, class Table>
constexpr bool have_unique_names(const Rows& rows, const Table& table) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_name(rows[i].name)) return false;
    for (const auto& row : table)
      if (row.name == rows[i].name) return false;
    for (std::size_t other = 0; other < i; ++other)
      if (rows[i].name == rows[other].name) return false;
  }
  return true;
}

template <class Rows>
constexpr bool have_valid_ranges(const Rows& rows) {
  for (const auto& row : rows)
    if (!(row.minimum <= row.default_value && row.default_value <= row.maximum)) return false;
  return true;
}

/// Replaces an invalid force law, so that the compiler reports no further errors.
struct NoLaw {
  [[maybe_unused]] static constexpr std::string_view help = "";
  struct Parameters {};
  struct Signals {};
  struct State {};
  static Vector3 force_N(const Probe&, const Parameters&, State&, Signals&) { return {}; }
};

using ChosenLaw = force_laws::INKWELL_FORCE_LAW;

static_assert(IsDefined<ChosenLaw>,
              "the file of the force law must define a struct named like the file, in namespace inkwell::force_laws");
static_assert(
    !IsDefined<ChosenLaw> || HasParts<ChosenLaw>,
    "the force law lacks one of its structs: Parameters, Signals, State; those it does not need may be empty");
static_assert(!IsDefined<ChosenLaw> || HasHelp<ChosenLaw>,
              "the force law lacks a sentence on what it is: static constexpr std::string_view help");
static_assert(
    !HasParts<ChosenLaw> || HasFunction<ChosenLaw>,
    "the force law lacks its function: static Vector3 force_N(const Probe&, const Parameters&, State&, Signals&)");
static_assert(!HasParts<ChosenLaw> || HasSmallState<ChosenLaw>,
              "the State of the force law must be made of plain numbers with initial values, no larger than "
              "ForceLawMemory::state_bytes");

using Law =
    std::conditional_t<HasFunction<ChosenLaw> && HasSmallState<ChosenLaw> && HasHelp<ChosenLaw>, ChosenLaw, NoLaw>;
using Parameters = Law::Parameters;
using State = Law::State;
using Signals = Law::Signals;

constexpr auto parameters = parameter_rows<Law>();
constexpr auto signals = signal_rows<Law>();

static_assert(fit_rows<Parameters>(parameters),
              "each member of the force law's Parameters must be a float with one row in `parameter_rows`");
static_assert(fit_rows<Signals>(signals),
              "each member of the force law's Signals must be a float with one row in `signal_rows`");
static_assert(parameters.size() <= protocol::force_law_parameters_maximum,
              "the force law has more parameters than protocol::force_law_parameters_maximum");
static_assert(signals.size() <= protocol::force_law_signals_maximum,
              "the force law has more signals than protocol::force_law_signals_maximum");
static_assert(have_valid_ranges(parameters), "the default of a force law's parameter is outside of its range");
static_assert(
    have_unique_names(parameters, protocol::parameter_table),
    "names of a force law's parameters are letters, digits and _, at most 40, and no other parameter has them");
static_assert(have_unique_names(signals, protocol::signal_table),
              "names of a force law's signals are letters, digits and _, at most 40, and no other signal has them");

// ---- the report ---------------------------------------------------------------------------------------

#define INKWELL_TEXT_OF(name) #name
#define INKWELL_TEXT(name) INKWELL_TEXT_OF(name)
constexpr std::string_view law_name = INKWELL_TEXT(INKWELL_FORCE_LAW);

/// Writes a report or counts its bytes.
struct ReportWriter {
  std::byte* to;
  std::size_t size = 0;

  constexpr void byte(std::size_t value) {
    if (to != nullptr) to[size] = static_cast<std::byte>(value);
    ++size;
  }
  constexpr void number(float value) {
    for (int bit = 0; bit < 32; bit += 8) byte(std::bit_cast<std::uint32_t>(value) >> bit & 0xFF);
  }
  constexpr void text(std::string_view text) {
    for (const char c : text) byte(static_cast<unsigned char>(c));
    byte(0);
  }
};

constexpr std::size_t write_report(std::byte* to, std::size_t size) {
  ReportWriter writer{to};
  writer.byte(static_cast<std::size_t>(protocol::ReportId::force_law));
  writer.byte(parameters.size());
  writer.byte(signals.size());
  writer.byte(0);
  writer.byte(size & 0xFF);
  writer.byte(size >> 8);
  writer.text(law_name);
  writer.text(Law::help);
  for (const auto& row : parameters) {
    writer.number(row.minimum);
    writer.number(row.maximum);
    writer.number(row.default_value);
    writer.text(row.name);
    writer.text(row.unit);
    writer.text(row.help);
  }
  for (const auto& row : signals) {
    writer.text(row.name);
    writer.text(row.unit);
    writer.text(row.help);
  }
  return writer.size;
}

constexpr std::size_t report_size = write_report(nullptr, 0);
static_assert(report_size <= protocol::force_law_report_maximum,
              "names, units and helps of the force law are longer than protocol::force_law_report_maximum");

// This data is in flash, because only the main loop uses it.
#if defined(__arm__)
#define INKWELL_IN_FLASH [[gnu::section(".force_law_rows")]]
#else
#define INKWELL_IN_FLASH
#endif

INKWELL_IN_FLASH constexpr auto report = []() {
  std::array<std::byte, report_size> bytes{};
  write_report(bytes.data(), report_size);
  return bytes;
}();

}  // namespace

INKWELL_IN_FLASH constinit const InstalledForceLaw installed_force_law = []() {
  InstalledForceLaw law{parameters.size(), signals.size(), {}, report.data(), report.size()};
  for (std::size_t i = 0; i < parameters.size(); ++i)
    law.ranges[i] = {parameters[i].minimum, parameters[i].maximum, parameters[i].default_value};
  return law;
}();

// ---- control interrupt --------------------------------------------------------------------------------

namespace {

/// The fold expression compiles to code without a loop.
template <std::size_t count, class Do>
void for_each_index(Do&& run) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (run(std::integral_constant<std::size_t, i>{}), ...); }
  (std::make_index_sequence<count>());
}

}  // namespace

extern const std::size_t force_law_signal_count = signals.size();

void reset_force_law(ForceLawMemory& memory) {
  // The state is copied by a loop, because the interrupt must not call memcpy.
  static constexpr State as_new{};
  const auto* from = reinterpret_cast<const std::byte*>(&as_new);
  for (std::size_t i = 0; i < sizeof as_new; ++i) memory.state[i] = from[i];
  for_each_index<signals.size()>([&](auto i) { memory.signals[i] = 0.0f; });
}

void step_force_law(const Probe& probe, const ForceLawValues& values, ForceLawMemory& memory, Vector3& force_N) {
  Parameters given{};
  Signals seen{};
  auto& state = *std::launder(reinterpret_cast<State*>(memory.state.data()));
  for_each_index<parameters.size()>([&](auto i) { given.*parameters[i].value = values[i]; });
  force_N = Law::force_N(probe, given, state, seen);
  for_each_index<signals.size()>([&](auto i) { memory.signals[i] = seen.*signals[i].value; });
}

}  // namespace inkwell::control
