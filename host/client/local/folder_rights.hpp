// Checks whether other users can replace this user's files in a folder.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace inkwell::local {

/// Returns true if the folder exists and no other user except root can remove or rename this user's files there.
inline bool only_owner_changes(const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return false;
  const bool is_trusted = status.st_uid == ::geteuid() || status.st_uid == 0;
  const bool others_write = (status.st_mode & (S_IWGRP | S_IWOTH)) != 0;
  return is_trusted && (!others_write || (status.st_mode & S_ISVTX) != 0);
}

}  // namespace inkwell::local
