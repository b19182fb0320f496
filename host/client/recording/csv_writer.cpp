// CSV recordings: lines "# key = value" about the recording, a line of column names, and a line for each sample. A line
// "# simulated NAME = description" marks a column from a simulation. A line "# mark PERIOD KIND CLOCK = description"
// comes between samples, close to the samples of its period. A line "# clock PERIOD = MICROSECONDS" states the time of
// the computer, in microseconds since 1970, at which the sample of this period arrived.
#include "host/client/recording/formats.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "host/client/process/fork.hpp"

namespace inkwell::recording {
namespace {

class CsvWriter final : public Writer {
 public:
  CsvWriter(const std::filesystem::path& file, const Information& information, std::string name)
      : name_(std::move(name)), file_(std::fopen(file.c_str(), "wbx")), simulated_(information.simulated.size()) {
    if (!file_) fail();
    own_ = process::OwnDescriptor(fileno(file_.get()));
    write_head(information);
    flush();
  }

  void append(const device::ScopeSamples& samples, std::span<const float> simulated) override {
    const std::size_t width = samples.signals.size();
    for (std::size_t i = 0; i < samples.count; ++i) {
      const std::int64_t period = samples.first_period + static_cast<std::int64_t>(i);
      fmt::format_to(std::back_inserter(text_), "{:.5f}", device::board_time_s(period));
      for (std::size_t j = 0; j < width; ++j)
        fmt::format_to(std::back_inserter(text_), ",{}", samples.values[i * width + j]);
      for (std::size_t j = 0; j < simulated_; ++j)
        fmt::format_to(std::back_inserter(text_), ",{}", simulated[i * simulated_ + j]);
      text_.push_back('\n');
    }
    if (text_.size() > 1 << 20) write_text();
  }
  void mark(const Mark& mark) override {
    std::string one_line = mark.text;
    for (char& c : one_line)
      if (c == '\n' || c == '\r') c = ' ';
    const auto out = std::back_inserter(text_);
    if (mark.clock_utc.empty())
      fmt::format_to(out, "# mark {} = {}\n", mark.period, one_line);
    else
      fmt::format_to(out, "# mark {} {} {} = {}\n", mark.period, name_of(mark.kind), mark.clock_utc, one_line);
  }
  void clock(const ClockReading& reading) override {
    fmt::format_to(std::back_inserter(text_), "# clock {} = {}\n", reading.period, reading.utc_us);
  }
  void flush() override {
    write_text();
    if (std::fflush(file_.get()) != 0) fail();
  }
  void end(bool is_complete) override {
    fmt::format_to(std::back_inserter(text_), "# complete = {}\n", is_complete ? 1 : 0);
    flush();
    own_.forget();
    if (std::fclose(file_.release()) != 0) fail();
  }

 private:
  void write_head(const Information& about) {
    auto out = std::back_inserter(text_);
    fmt::format_to(out, "# {} = {}\n# name = {}\n# note = {}\n# created_utc = {}\n", format_name, format_version,
                   about.name, about.note, about.created_utc);
    fmt::format_to(out, "# library_version = {}\n# library_sha256 = {}\n# image_sha256 = {}\n# arm_sha256 = {}\n",
                   about.library_version, about.library_sha256, about.image_sha256, about.arm_sha256);
    fmt::format_to(out, "# image_check = {}\n# firmware_version = {}\n# protocol_version = {}\n", about.image_check,
                   about.firmware_version, about.protocol_version);
    fmt::format_to(out, "# serial_number = {}\n# arm = {}\n# simulation = {}\n", about.serial_number, about.arm,
                   about.simulation ? 1 : 0);
    if (about.step_periods != 1) fmt::format_to(out, "# step_periods = {}\n", about.step_periods);
    if (about.force_law) fmt::format_to(out, "# force_law = {}\n", force_law_digits(about));
    for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
      fmt::format_to(out, "# parameter {} = {}\n", protocol::known_parameters()[i].name, about.parameters.values[i]);
    fmt::format_to(out, "# unit time_s = s\n");
    for (const auto signal : about.signals)
      fmt::format_to(out, "# unit {} = {}\n", protocol::info(signal).name, protocol::info(signal).unit);
    for (const auto quantity : about.simulated) {
      const auto& row = protocol::info(quantity);
      fmt::format_to(out, "# unit {0} = {1}\n# simulated {0} = {2}\n", row.name, row.unit, row.help);
    }
    fmt::format_to(out, "time_s");
    for (const auto signal : about.signals) fmt::format_to(out, ",{}", protocol::info(signal).name);
    for (const auto quantity : about.simulated) fmt::format_to(out, ",{}", protocol::info(quantity).name);
    fmt::format_to(out, "\n");
  }
  void write_text() {
    if (text_.size() != 0 && std::fwrite(text_.data(), 1, text_.size(), file_.get()) != text_.size()) fail();
    text_.clear();
  }
  [[noreturn]] void fail() const {
    throw device::Error(fmt::format("{} cannot be written: {}. Free some space or choose another location.", name_,
                                    std::strerror(errno)));
  }

  std::string name_;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  process::OwnDescriptor own_;  ///< a child process would write the buffered data again
  std::size_t simulated_;       ///< number of simulated quantities after the signals
  fmt::memory_buffer text_;
};

}  // namespace

std::unique_ptr<Writer> create_csv(const std::filesystem::path& file, const Information& information,
                                   const std::string& name) {
  return std::make_unique<CsvWriter>(file, information, name);
}

}  // namespace inkwell::recording
