// Helper program of the import. Reads one file with a library, and writes a message (pipe_format.hpp) to standard
// output. The starter is read_in_child().
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>

#include <fmt/format.h>

#include "host/import/error.hpp"
#include "host/import/format.hpp"
#include "host/import/pipe_format.hpp"
#include "host/import/program/object_readers.hpp"

namespace inkwell::importer {

std::vector<std::byte> read_file(const std::filesystem::path& file, const std::string& name) {
  const std::string own_name = file.filename().string();
  const std::string which = own_name == name ? name : fmt::format("{}, which {} requires,", own_name, name);
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    throw Error(fmt::format("{} does not exist or is not a file. Copy it into the same folder.", which));
  const auto size = std::filesystem::file_size(file, code);
  if (code || size > file_bytes_max)
    throw Error(
        fmt::format("{} is larger than {} MB. Reduce the object in a mesh editor.", which, file_bytes_max >> 20));
  std::vector<std::byte> bytes(size);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw Error(fmt::format("{} cannot be read. Check its permissions.", which));
  return bytes;
}

namespace {

FileContent read_with_library(Format format, const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  switch (format) {
    case Format::obj: return read_obj(file, name);
    case Format::gltf: return read_gltf(file, name);
    case Format::vrml: return read_vrml(file, name);
    case Format::stl:
    case Format::ply: break;
  }
  throw Error(fmt::format("{} needs no library. Use import_object().", name));
}

std::vector<std::byte> message_about(Format format, const std::filesystem::path& file) {
  try {
    return encode(read_with_library(format, file));
  } catch (const Error& error) {
    return encode_refusal(error.what());
  } catch (const std::bad_alloc&) {
    return encode_refusal(
        fmt::format("{} needs too much memory. Reduce the object in a mesh editor.", file.filename().string()));
  } catch (const std::exception& error) {
    return encode_refusal(
        fmt::format("{} is damaged or unusual: {}. Export the object as STL.", file.filename().string(), error.what()));
  }
}

void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  const rlimit limits{value, value};
  setrlimit(resource, &limits);
}

bool write_all(int output, std::span<const std::byte> message) {
  while (!message.empty()) {
    const ssize_t count = ::write(output, message.data(), message.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    message = message.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

int run(int argument_count, char** arguments) {
  const auto number = [&](int index) {
    std::uint64_t value = 0;
    std::from_chars(arguments[index], arguments[index] + std::strlen(arguments[index]), value);
    return value;
  };
  const auto format = argument_count == 5 ? parse_format(arguments[1]) : std::nullopt;
  if (!format) {
    std::fputs("inkwell-import: this program is started by inkwell. Use `inkwell mesh FILE`.\n", stderr);
    return 2;
  }
  // A library may print to standard output, which must carry nothing but the message.
  const int output = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::signal(SIGXCPU, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, number(4));
#ifndef __SANITIZE_ADDRESS__  // the address sanitizer reserves terabytes of addresses
  limit(RLIMIT_AS, number(3));
#endif
  return write_all(output, message_about(*format, arguments[2])) ? 0 : 1;
}

}  // namespace
}  // namespace inkwell::importer

int main(int argument_count, char** arguments) { return inkwell::importer::run(argument_count, arguments); }
