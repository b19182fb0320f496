// A recording laid over another one: what it holds, on the other's time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <recording/recording.hpp>

namespace inkwell::recording {

class Overlay {
 public:
  /// The two are aligned at the first mark of this text that each of them holds, or, without one, at their begins.
  /// Throws device::Error with a sentence if one of them has no such mark, or holds no samples.
  Overlay(Recording over, const Recording& base, std::string_view mark = {});

  const Recording& recording() const { return over_; }
  /// When the recording that is laid over begins, since the other's first sample.
  double begins_s() const { return static_cast<double>(shift_periods_) / protocol::servo_rate_Hz; }
  /// Its values at the control periods of a block of the other one; NaN where it has none.
  device::ScopeSamples beside(const device::ScopeSamples& of_base) const;

 private:
  Recording over_;
  std::int64_t base_begins_periods_;  ///< the other's first control period
  std::int64_t shift_periods_ = 0;    ///< of the other's time, at which this one begins
};

/// What two recordings are called beside each other: their files without folder and ending, and with the folders, or
/// the endings, that tell them apart where these are the same.
std::pair<std::string, std::string> names_beside_each_other(const std::filesystem::path& one,
                                                            const std::filesystem::path& other);

/// The texts of marks that both hold, each once: by these they can be aligned.
std::vector<std::string> common_marks(const Recording& a, const Recording& b);

}  // namespace inkwell::recording
