// The two formats behind recording::create and recording::read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <recording/recording.hpp>
#include <recording/writer.hpp>

namespace inkwell::recording {

/// Information::force_law in hexadecimal digits; empty if there is none.
std::string force_law_digits(const Information& information);
/// Takes it from them, and puts the rows of the force law into the tables, before parameters and columns are looked up
/// there. What is wrong with it becomes a remark, with the file's name.
void take_force_law(Recording& recording, std::string_view digits, std::string_view file);

/// Whether a file's control period is a time that a board can have: thirty years at most.
bool can_be_period(std::int64_t written);
/// The control period that stands after `before` in a file. Files of earlier versions hold its lower 32 bits only,
/// which fall where the board's counter wraps.
std::int64_t period_after(std::int64_t before, std::int64_t written);

/// Information::step_periods as it stands in a file: 1 for what is none, such as in a file of an earlier version.
std::uint32_t step_periods_of(double written);

/// `name`: of the file in sentences, which is not always where it is written first.
std::unique_ptr<Writer> create_hdf5(const std::filesystem::path& file, const Information& information,
                                    const std::string& name);
Recording read_hdf5(const std::filesystem::path& file);
/// The same of a file's content. `name`: of the file in sentences.
Recording read_hdf5(std::span<const std::byte> content, const std::string& name);

std::unique_ptr<Writer> create_csv(const std::filesystem::path& file, const Information& information,
                                   const std::string& name);
/// `name`: of the file in sentences.
Recording read_csv(std::istream& stream, const std::string& name);

}  // namespace inkwell::recording
