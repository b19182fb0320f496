#include "host/client/device/feature_reports.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace inkwell::device {

Incompatible too_short(const char* what, std::size_t length, std::size_t wanted) {
  return Incompatible(fmt::format(
      "The device's {} report has {} bytes instead of {}. Flash the firmware that belongs to this companion.", what,
      length, wanted));
}

protocol::InformationReport read_information(Transport& transport) {
  constexpr std::size_t who_it_is = offsetof(protocol::InformationReport, parameter_table_hash);
  constexpr std::size_t who_an_old_one_is = offsetof(protocol::InformationReport, board);
  protocol::InformationReport report{};
  report.report_id = protocol::ReportId::information;
  const std::size_t length = transport.get_feature(writable_bytes(report));
  const bool is_ours = report.version == protocol::protocol_version;
  const std::size_t wanted = is_ours                                               ? sizeof report
                             : report.version < protocol::first_version_with_board ? who_an_old_one_is
                                                                                   : who_it_is;
  if (length < wanted) throw too_short("information", length, wanted);
  std::ranges::fill(writable_bytes(report).subspan(wanted), std::byte{0});
  return report;
}

}  // namespace inkwell::device
