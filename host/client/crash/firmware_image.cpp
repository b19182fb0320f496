#include "host/client/crash/firmware_image.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <cxxabi.h>
#include <elfutils/libdwfl.h>
#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "host/client/device/error.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::crash {
namespace {

int no_other_file(Dwfl_Module*, void**, const char*, Dwarf_Addr, const char*, const char*, GElf_Word, char**) {
  return -1;
}

const Dwfl_Callbacks callbacks{.find_elf = dwfl_build_id_find_elf,
                               .find_debuginfo = no_other_file,
                               .section_address = dwfl_offline_section_address,
                               .debuginfo_path = nullptr};

std::string readable(const char* name) {
  const std::unique_ptr<char, decltype(&std::free)> plain(abi::__cxa_demangle(name, nullptr, nullptr, nullptr),
                                                          &std::free);
  return plain ? plain.get() : name;
}

}  // namespace

struct FirmwareImage::Reader {
  std::unique_ptr<Dwfl, decltype(&dwfl_end)> session{dwfl_begin(&callbacks), &dwfl_end};
  Dwfl_Module* module = nullptr;
  Elf* elf = nullptr;
};

FirmwareImage::FirmwareImage(const std::filesystem::path& elf) : reader_(std::make_unique<Reader>()) {
  const int file = open(elf.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    throw device::Error(fmt::format("Cannot read {}: {}. Check its name.", elf.string(), std::strerror(errno)));
  // The module owns the open file.
  dwfl_report_begin(reader_->session.get());
  reader_->module = dwfl_report_offline(reader_->session.get(), elf.c_str(), elf.c_str(), file);
  if (reader_->module == nullptr) close(file);
  dwfl_report_end(reader_->session.get(), nullptr, nullptr);
  GElf_Addr bias = 0;
  if (reader_->module != nullptr) reader_->elf = dwfl_module_getelf(reader_->module, &bias);
  GElf_Ehdr header;
  if (reader_->elf == nullptr || gelf_getehdr(reader_->elf, &header) == nullptr || header.e_machine != EM_ARM)
    throw device::Error(
        fmt::format("{} is not a program for the board's processor. Give the ELF file of the firmware, which the build "
                    "writes next to the flashed file.",
                    elf.string()));
}

FirmwareImage::~FirmwareImage() = default;
FirmwareImage::FirmwareImage(FirmwareImage&&) noexcept = default;

std::optional<std::uint32_t> FirmwareImage::check() const {
  std::size_t names = 0;
  if (elf_getshdrstrndx(reader_->elf, &names) != 0) return std::nullopt;
  for (Elf_Scn* section = nullptr; (section = elf_nextscn(reader_->elf, section)) != nullptr;) {
    GElf_Shdr header;
    if (gelf_getshdr(section, &header) == nullptr) continue;
    const char* name = elf_strptr(reader_->elf, names, header.sh_name);
    if (name == nullptr || std::strcmp(name, ".image_check") != 0) continue;
    const Elf_Data* data = elf_rawdata(section, nullptr);
    std::array<unsigned char, 4> bytes;
    if (data == nullptr || data->d_buf == nullptr || data->d_size != bytes.size()) return std::nullopt;
    std::memcpy(bytes.data(), data->d_buf, bytes.size());
    return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
  }
  return std::nullopt;
}

std::string FirmwareImage::source_location(std::uint32_t address) const {
  GElf_Off offset = 0;
  GElf_Sym symbol;
  const char* name = dwfl_module_addrinfo(reader_->module, address, &offset, &symbol, nullptr, nullptr, nullptr);
  if (name == nullptr || GELF_ST_TYPE(symbol.st_info) != STT_FUNC || offset >= symbol.st_size) return "";
  const std::string function = protocol::plain_text(readable(name));
  Dwfl_Line* line = dwfl_module_getsrc(reader_->module, address);
  int number = 0;
  const char* source = line == nullptr ? nullptr : dwfl_lineinfo(line, nullptr, &number, nullptr, nullptr, nullptr);
  if (source == nullptr) return function;
  return fmt::format("{} ({}:{})", function, protocol::plain_text(std::filesystem::path(source).filename().string()),
                     number);
}

}  // namespace inkwell::crash
