// The HDF5 and CSV formats of recordings.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "host/client/recording/recording.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/client/recording/writer.hpp"

namespace inkwell::recording {

/// Information::force_law in hexadecimal digits; empty without a force law.
std::string force_law_digits(const Information& information);
/// Decodes the force law and adds its rows to the tables, before parameters and columns are looked up there. An invalid
/// force law becomes a remark with the file's name.
void take_force_law(Recording& recording, std::string_view digits, std::string_view file);

/// Returns true if the number of a control period in a file is plausible: at most thirty years.
bool can_be_period(std::int64_t written);
/// Returns the control period that follows `before` in a file. Files of earlier versions store only the lower 32 bits,
/// which wrap.
std::int64_t period_after(std::int64_t before, std::int64_t written);

/// Converts step_periods from a file: 1 if missing or invalid, as in a file of an earlier version.
std::uint32_t step_periods_of(double written);

/// `name`: the file's name in error sentences. The name can differ from the path during writing.
std::unique_ptr<Writer> create_hdf5(const std::filesystem::path& file, const Information& information,
                                    const std::string& name);
StoredRecording open_hdf5(const std::filesystem::path& file);
/// Opens the content of a file. `name`: the file's name in error sentences.
StoredRecording open_hdf5(std::span<const std::byte> content, const std::string& name);

std::unique_ptr<Writer> create_csv(const std::filesystem::path& file, const Information& information,
                                   const std::string& name);
/// Indexes the samples, which stay in the stream. `name`: the file's name in error sentences.
StoredRecording open_csv(std::unique_ptr<std::istream> stream, const std::string& name);

}  // namespace inkwell::recording
