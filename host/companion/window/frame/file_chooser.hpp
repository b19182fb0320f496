// The window's file dialog. The user must confirm the replacement of an existing file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/companion/window/frame/folder_listing.hpp"
#include "host/companion/window/frame/style.hpp"

namespace inkwell::window {

struct FileQuestion {
  std::string title;
  std::string help;
  std::string button;                ///< "Load", "Save"
  std::vector<std::string> endings;  ///< extensions of the selectable files, such as ".toml"; the first is the default
  bool is_new_file = false;          ///< true: the file is written and need not exist
  std::filesystem::path suggestion;  ///< initial file or folder; empty: the working folder
};

class FileChooser {
 public:
  void ask(FileQuestion question);
  /// Draws the open dialog. After the user's choice, returns the file once.
  std::optional<std::filesystem::path> draw(const Style& style);

 private:
  void enter(const std::filesystem::path& folder);
  void draw_folders(const Style& style);
  void draw_entries(const Style& style);
  bool draw_filter(const Style& style);
  void accept();
  bool draw_buttons(const Style& style);

  FileQuestion question_;
  bool is_asked_ = false;
  bool shows_all_files_ = false;
  std::filesystem::path folder_;
  FolderListing listing_;
  double listed_at_s_ = 0.0;
  std::string typed_;
  std::string problem_;
  std::optional<std::filesystem::path> chosen_;
  std::optional<std::filesystem::path> to_be_replaced_;  ///< waits for the user's confirmation
};

}  // namespace inkwell::window
