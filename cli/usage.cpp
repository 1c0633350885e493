#include "cli/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace batten::cli {

namespace {

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(verb->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

std::string unknown_option_text(const CLI::App& verb, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  const std::string dashes = name[1] == '-' ? "" : "-";  // -levels stands for --levels
  return name + ": " + verb.get_display_name() + " has no such option" + suggestion(dashes + name, option_names(verb));
}

std::string no_verb_text(const CLI::App& app, const std::vector<std::string>& left) {
  std::string all;
  for (const std::string& name : verb_names(app)) all += (all.empty() ? "" : ", ") + name;
  if (left.empty()) return "name a verb: " + all;
  if (is_option(left.front())) return unknown_option_text(app, left.front());
  const std::string near = suggestion(left.front(), verb_names(app));
  return "'" + left.front() + "' is not a verb" + (near.empty() ? "; name one of " + all : near);
}

/// CLI11 speaks of numbers of arguments; people leave a value out, give an option twice, or too few numbers in a list.
std::string mismatch_text(const CLI::App& verb, const CLI::ParseError& error) {
  const std::string text = error.what();
  const std::string option = text.substr(0, text.find(':'));
  const CLI::Option* known = verb.get_option_no_throw(option);
  if (known != nullptr && known->get_delimiter() != '\0' && known->get_expected_min() > 1)
    return fmt::format("{} takes {} numbers with commas between", option, known->get_expected_min());
  return option + (text.find("missing") != std::string::npos ? " needs a value" : " is given more than once");
}

/// "Could not convert: --seed = a,b,c"
std::string conversion_text(const CLI::ParseError& error) {
  std::string text = error.what();
  const std::size_t option = text.find("--");
  const std::size_t equals = text.find(" = ");
  if (option == std::string::npos || equals == std::string::npos || equals < option) return text;
  return text.substr(option, equals - option) + ": '" + text.substr(equals + 3) + "' is not a number";
}

/// True if the whole text is a number.
template <typename Number>
bool read(const std::string& text, Number& number) {
  std::istringstream stream(text);
  return static_cast<bool>(stream >> number) && stream.peek() == std::istringstream::traits_type::eof();
}

}  // namespace

std::string usage_text(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  if (parsed.empty()) return no_verb_text(app, app.remaining());
  const CLI::App& verb = *parsed.front();
  const std::vector<std::string> left = verb.remaining();
  // The value of an unknown option is taken for a file, so the option is what is wrong.
  const auto unknown = std::find_if(left.begin(), left.end(), is_option);
  if (unknown != left.end()) return unknown_option_text(verb, *unknown);
  if (!left.empty()) return "'" + left.front() + "': " + verb.get_name() + " takes no further file";
  if (error.get_name() == "ConversionError") return conversion_text(error);
  return error.get_name() == "ArgumentMismatch" ? mismatch_text(verb, error) : error.what();
}

bool is_given(const CLI::App& verb, const std::string& option) {
  const CLI::Option* found = verb.get_option_no_throw(option);
  return found != nullptr && found->count() > 0;
}

void require_alone(const CLI::App& verb, const std::string& name, const std::vector<std::string>& others) {
  const auto given = [&](const std::string& option) { return is_given(verb, option); };
  const auto other = std::find_if(others.begin(), others.end(), given);
  if (other != others.end()) throw UsageError(*other + " does nothing with " + name + "; leave one of them out");
}

void require_with(const CLI::App& verb, const std::vector<std::string>& options,
                  const std::vector<std::string>& needed) {
  const auto given = [&](const std::string& option) { return is_given(verb, option); };
  if (std::any_of(needed.begin(), needed.end(), given)) return;
  std::string names;
  for (const std::string& name : needed) {
    if (verb.get_option_no_throw(name) == nullptr) continue;
    names += names.empty() ? "" : " or ";
    names += name;
  }
  const auto option = std::find_if(options.begin(), options.end(), given);
  if (option != options.end()) throw UsageError(*option + " does nothing without " + names);
}

CLI::Validator whole_number(long long low, long long high) {
  const bool open = high >= std::numeric_limits<int>::max();
  const std::string words = open ? fmt::format("{} or more", low) : fmt::format("{} to {}", low, high);
  return {[low, high, words](const std::string& text) {
            long long number = 0;
            if (read(text, number) && number >= low && number <= high) return std::string();
            return "'" + text + "' is not a whole number (" + words + ")";
          },
          words};
}

CLI::Validator number_in(double low, double high) {
  const std::string words = fmt::format("{:.12g} to {:.12g}", low, high);
  return {[low, high, words](const std::string& text) {
            double number = 0.0;
            if (read(text, number) && number >= low && number <= high) return std::string();
            return "'" + text + "' is not a number from " + words;
          },
          words};
}

CLI::Validator positive_number() {
  return {[](const std::string& text) {
            double number = 0.0;
            if (read(text, number) && number > 0.0 && std::isfinite(number)) return std::string();
            return "'" + text + "' is not a number above 0";
          },
          "above 0"};
}

}  // namespace batten::cli
