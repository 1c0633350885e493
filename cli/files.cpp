#include "cli/files.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "batten/error.h"
#include "batten/output.h"
#include "cli/input_output.h"
#include "cli/usage.h"

namespace batten::cli {

namespace fs = std::filesystem;

namespace {

/// CLI11 keeps a type name with each option, which tells the kinds of files from all other arguments. The help
/// shows it where an option has no text of its own.
constexpr const char* kInputType = "FILE";
constexpr const char* kVolumeType = "VOLUME";
constexpr const char* kOutputType = "OUTPUT FILE";

struct FileOption {
  std::string option;
  std::string path;
};

std::vector<FileOption> given_files(const CLI::App& verb, const std::string& type) {
  std::vector<FileOption> files;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_type_name() != type) continue;
    for (const std::string& path : option->results()) files.push_back({option->get_name(), path});
  }
  return files;
}

/// The name under which the file system knows a file.
fs::path system_name(const std::string& path, const char* standard) { return path == "-" ? standard : path; }

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return fs::is_regular_file(a, error);
  const fs::path first = fs::weakly_canonical(fs::absolute(a, error), error);
  return !error && first == fs::weakly_canonical(fs::absolute(b, error), error) && !io::is_special_target(a.string());
}

void refuse_folders(const std::vector<FileOption>& files, ErrorCode code, const std::string& what) {
  for (const FileOption& file : files) {
    std::error_code error;
    if (!fs::is_directory(file.path, error)) continue;
    throw Error(code, file.path + ": cannot be " + what + ": it is a folder; name a file in it");
  }
}

/// Refuses an input that is NAME-000 of `output`, or one of the next, so many in all.
void refuse_numbered(const std::string& output, const std::string& input, int count) {
  std::error_code error;
  const std::string stem = fs::canonical(input, error).stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  if (error || digits == stem.size() || stem.size() - digits > 6) return;
  const int number = std::stoi(stem.substr(digits));
  if (number >= count || !same_file(numbered(output, static_cast<std::size_t>(number)), input)) return;
  throw UsageError("--output: '" + input + "' is a file to read, which a frame would replace; choose another name");
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

CLI::Validator has_extension(const std::vector<std::string>& extensions) {
  return {[extensions](const std::string& name) {
            if (io::is_special_target(name)) return std::string();
            const std::string own = lower(fs::path(name).extension().string());
            std::string words;
            for (const std::string& extension : extensions) {
              if (own == extension) return std::string();
              words += (words.empty() ? "" : " or ") + extension;
            }
            return "'" + name + "' should end in " + words + ", or be - for standard output";
          },
          ""};
}

}  // namespace

bool is_standard_output(const std::string& path) { return path == "-" || path == "/dev/stdout"; }

CLI::Option* add_input_file(CLI::App& verb, const std::string& name, std::string& target, const std::string& help) {
  return verb.add_option(name, target, help)->type_name(kInputType);
}

CLI::Option* add_input_volume(CLI::App& verb, const std::string& name, std::string& target, const std::string& help) {
  return verb.add_option(name, target, help)->type_name(kVolumeType)->option_text(kVolumeType);
}

CLI::Option* add_input_files(CLI::App& verb, const std::string& name, std::vector<std::string>& targets,
                             const std::string& help) {
  return verb.add_option(name, targets, help)->type_name(kInputType)->allow_extra_args(false);
}

CLI::Option* add_output_file(CLI::App& verb, const std::string& name, std::string& target, const std::string& help,
                             const std::vector<std::string>& extensions) {
  CLI::Option* option = verb.add_option(name, target, help)->type_name(kOutputType);
  std::string text = "FILE";
  for (const std::string& extension : extensions) text += (&extension == &extensions.front() ? "" : "|") + extension;
  if (!extensions.empty()) option->check(has_extension(extensions));
  return option->option_text(text);
}

void check_files(const CLI::App& verb, CommonArguments& common) {
  std::vector<FileOption> inputs = given_files(verb, kInputType);
  const std::vector<FileOption> outputs = given_files(verb, kOutputType);
  refuse_folders(inputs, ErrorCode::FileNotReadable, "read");
  const std::vector<FileOption> volumes = given_files(verb, kVolumeType);
  inputs.insert(inputs.end(), volumes.begin(), volumes.end());
  refuse_folders(outputs, ErrorCode::FileNotWritable, "written");
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const FileOption& output = outputs[i];
    const fs::path name = system_name(output.path, "/dev/stdout");
    for (const FileOption& input : inputs) {
      if (!same_file(name, system_name(input.path, "/dev/stdin"))) continue;
      throw UsageError(output.option + ": '" + output.path +
                       "' is the file to read, which it would replace; name another one");
    }
    for (std::size_t j = 0; j < i; ++j) {
      const bool both = is_standard_output(output.path) && is_standard_output(outputs[j].path);
      if (!both && !same_file(name, system_name(outputs[j].path, "/dev/stdout"))) continue;
      throw UsageError(output.option + ": '" + output.path + "' is what " + outputs[j].option +
                       " writes; name another one");
    }
    if (is_standard_output(output.path)) common.text_to_stderr = true;
  }
}

void check_numbered_files(const CLI::App& verb, const std::string& output, int count) {
  for (const FileOption& input : given_files(verb, kInputType)) refuse_numbered(output, input.path, count);
}

void require_others(const std::vector<std::string>& outputs, const std::vector<std::string>& read, bool numbers) {
  for (const std::string& output : outputs) {
    for (const std::string& input : read) {
      if (output.empty() || input.empty()) continue;
      if (same_file(system_name(output, "/dev/stdout"), input))
        throw UsageError("'" + output + "' is a file to read, which would be replaced; name another one");
      if (numbers) refuse_numbered(output, input, std::numeric_limits<int>::max());
    }
  }
}

void require_output(const CLI::App& verb, const std::vector<std::string>& instead) {
  if (!given_files(verb, kOutputType).empty()) return;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_type_name() == kOutputType) add(option->get_name());
  }
  for (const std::string& name : instead) {
    if (verb.count(name) > 0) return;
    add(name);
  }
  throw UsageError(verb.get_name() + ": nothing would be written; give one of " + CLI::detail::join(names, ", "));
}

}  // namespace batten::cli
