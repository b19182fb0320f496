// The window's own dialog for files: folders, names, sizes and dates, a typed path, and a question before a file is
// replaced.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <frame/folder_listing.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

struct FileQuestion {
  std::string title;
  std::string help;
  std::string button;                ///< "Load", "Save"
  std::vector<std::string> endings;  ///< of the files that are meant: ".toml"; a new file gets the first one
  bool is_new_file = false;          ///< it will be written, so it need not exist
  std::filesystem::path suggestion;  ///< where to begin: a file or a folder; empty: the working folder
};

class FileChooser {
 public:
  void ask(FileQuestion question);
  /// Draws the dialog while it is open; gives the file once, when it was chosen.
  std::optional<std::filesystem::path> draw(const Style& style);

 private:
  void enter(const std::filesystem::path& folder);
  void draw_places(const Style& style);
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
  std::optional<std::filesystem::path> to_be_replaced_;  ///< waits for the answer whether it may be
};

}  // namespace inkwell::window
