// The pane with a slider for every parameter of the table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <device_desk/parameter_editor.hpp>
#include <frame/file_chooser.hpp>
#include <frame/style.hpp>

namespace inkwell::window {

class TuningPane {
 public:
  explicit TuningPane(std::filesystem::path parameters_file) : path_(parameters_file.string()) {}

  /// `refusal`: why the device refused the newest transaction; empty if it did not.
  void draw(ImVec2 place, ImVec2 size, const Style& style, ParameterEditor& editor, const std::string& refusal,
            double now_s);

  /// Loads a file as one undo step; says in the pane what became of it.
  void load(const std::filesystem::path& path, ParameterEditor& editor, double now_s);
  std::filesystem::path parameters_file() const { return path_; }

 private:
  enum class FileTask : std::uint8_t { load, save };

  void draw_heading(const Style& style, ParameterEditor& editor, double now_s);
  void draw_presets(const Style& style, ParameterEditor& editor, double now_s);
  void draw_messages(const Style& style, const std::string& refusal);
  void draw_group(std::string_view group, const Style& style, ParameterEditor& editor, double now_s);
  void draw_row(protocol::Parameter parameter, const Style& style, ParameterEditor& editor, double now_s);
  void ask_for_file(FileTask task);
  void draw_file_dialog(const Style& style, ParameterEditor& editor, double now_s);
  void save(const ParameterEditor& editor);

  std::string path_;
  FileTask task_ = FileTask::load;
  FileChooser chooser_;
  std::vector<std::string> messages_;  // about the file loaded or saved last
  bool message_is_error_ = false;
};

}  // namespace inkwell::window
