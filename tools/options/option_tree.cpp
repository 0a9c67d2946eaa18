#include "tools/options/option_tree.h"

#include "tools/options/command_options.h"

namespace spillway::detail {
namespace {

std::vector<std::string> split_words(const std::string& type_name) {
  if (type_name.find('|') == std::string::npos) return {};
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= type_name.size();) {
    const std::size_t end = std::min(type_name.find('|', begin), type_name.size());
    words.push_back(type_name.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

OptionInfo describe(const CLI::Option& option) {
  OptionInfo info;
  info.positional = option.get_positional();
  if (info.positional) {
    info.names = {option.get_name(true, false)};
  } else {
    for (const std::string& name : option.get_snames()) info.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) info.names.push_back("--" + name);
  }
  if (option.get_type_size() != 0) {
    info.words = split_words(option.get_type_name());
    info.value_name = info.positional ? info.names.front() : option.get_type_name();
  }
  info.description = option.get_description();
  info.default_value = option.get_default_str();
  info.required = option.get_required();
  info.many = takes_many(option);
  return info;
}

}  // namespace

bool OptionInfo::names_file() const {
  return words.empty() && (value_name == "FILE" || value_name == "IN" || value_name == "MESH");
}

std::vector<OptionInfo> options_of(const CLI::App& app) {
  std::vector<OptionInfo> options;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional() == positional) options.push_back(describe(*option));
    }
  }
  return options;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands(
      [](const CLI::App* subcommand) { return !subcommand->get_name().empty(); });
}

}  // namespace spillway::detail
