// The two formats behind recording::create and recording::read.
#pragma once

#include <filesystem>
#include <memory>

#include <recording/recording.hpp>
#include <recording/writer.hpp>

namespace inkwell::recording {

std::unique_ptr<Writer> create_hdf5(const std::filesystem::path& file, const Information& information);
Recording read_hdf5(const std::filesystem::path& file);

std::unique_ptr<Writer> create_csv(const std::filesystem::path& file, const Information& information);
Recording read_csv(const std::filesystem::path& file);

}  // namespace inkwell::recording
