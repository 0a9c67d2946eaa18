#include "tools/options/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "tools/options/help_layout.h"

namespace spillway::command {
namespace {

/// Whether an option, or a positional, takes any number of arguments.
bool takes_many(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size &&
         option.get_allow_extra_args();
}

/// The headings of a command line's options, those first that are needed first.
std::vector<std::string> groups_in_order(const CLI::App& app) {
  constexpr std::array<std::string_view, 5> kLast = {kFilterGroup, kTableGroup, kResourceGroup,
                                                     kReportGroup, kTuningGroup};
  std::vector<std::string> groups = app.get_groups();
  std::ranges::stable_sort(groups, {}, [&](const std::string& group) {
    const auto place = std::ranges::find(kLast, group);
    return place == kLast.end() ? 0 : place - kLast.begin() + 1;
  });
  return groups;
}

/// Help with `--option VALUE  description [default]`.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode /*mode*/) const override {
    return make_description(app) + make_usage(app, name) + make_positionals(app) +
           make_sorted_groups(*app) + make_subcommands(app, CLI::AppFormatMode::Normal) + "\n" +
           make_footer(app);
  }

  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), width_) + "\n";
  }

  std::string make_footer(const CLI::App* app) const override {
    return wrapped(app->get_footer(), width_) + "\n";
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return help_entry(make_option_name(option, is_positional) + make_option_opts(option),
                      make_option_desc(option), width_);
  }

  std::string make_subcommand(const CLI::App* app) const override {
    return help_entry(app->get_name(), app->get_description(), width_);
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    const bool many = takes_many(*option);
    if (option->get_positional()) return many ? "..." : "";
    if (option->get_type_size() == 0) return "";
    return " " + option->get_type_name() + (many ? "..." : "");
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    if (option->get_required() && !option->get_positional()) text += " [required]";
    if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
    return text;
  }

 private:
  /// What make_groups() makes in the order in which the headings appeared first.
  [[nodiscard]] std::string make_sorted_groups(const CLI::App& app) const {
    std::string text;
    for (const std::string& group : groups_in_order(app)) {
      const auto options = app.get_options([&](const CLI::Option* option) {
        return option->get_group() == group && option->nonpositional();
      });
      if (!options.empty()) text += make_group(group, false, options);
    }
    return text;
  }

  std::size_t width_ = help_width();
};

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

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::value_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::group(const std::string& heading) {
  option_->group(heading);
  return *this;
}

Option Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option Option::show_default(const std::string& text) {
  option_->default_str(text);
  return *this;
}

Option Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words).description(""));
  return *this;
}

Option Option::check(std::function<std::string(std::string&)> wrong) {
  option_->transform(CLI::Validator(std::move(wrong), ""));
  return *this;
}

Option Option::each(const std::function<void(const std::string&)>& tell) {
  option_->each(tell);
  return *this;
}

Option Option::one_argument() {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::once() {
  option_->expected(1);
  return *this;
}

Option Option::commas_separate() {
  option_->delimiter(',');
  return *this;
}

bool OptionInfo::names_file() const {
  if (words.empty()) {
    return value_name == "FILE" || value_name == "DIR" || value_name == "IN" ||
           value_name == "MESH";
  }
  return std::ranges::find(words, "FILE") != words.end();
}

struct CommandLine::Impl {
  std::unique_ptr<CLI::App> root;  ///< null for a subcommand
  CLI::App* app;
  std::vector<std::unique_ptr<CommandLine>> subcommands;
};

CommandLine::CommandLine() : impl_(std::make_unique<Impl>()) {
  impl_->root = std::make_unique<CLI::App>();
  impl_->app = impl_->root.get();
  impl_->app->set_help_flag();
}

CommandLine::CommandLine(const std::string& name, const std::string& description,
                         const std::string& version)
    : impl_(std::make_unique<Impl>()) {
  impl_->root = std::make_unique<CLI::App>(description, name);
  CLI::App& app = *impl_->root;
  impl_->app = &app;
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_version_flag("-V,--version", version, "Print the version and exit");
  app.require_subcommand(1);
}

CommandLine::CommandLine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

CommandLine::~CommandLine() = default;

CommandLine& CommandLine::add_subcommand(const std::string& name, const std::string& description) {
  auto impl = std::make_unique<Impl>();
  impl->app = impl_->app->add_subcommand(name, description);
  impl->app->get_help_ptr()->group(kReportGroup);
  impl_->subcommands.emplace_back(new CommandLine(std::move(impl)));
  return *impl_->subcommands.back();
}

void CommandLine::set_footer(const std::string& footer) { impl_->app->footer(footer); }

Option CommandLine::add_flag(const std::string& names, bool& given,
                             const std::string& description) {
  return Option(impl_->app->add_flag(names, given, description));
}

Option CommandLine::add_option(const std::string& names, std::string& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, double& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, std::optional<double>& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, int& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, unsigned& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, std::uint64_t& value,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, value, description));
}

Option CommandLine::add_option(const std::string& names, std::vector<std::string>& values,
                               const std::string& description) {
  return Option(impl_->app->add_option(names, values, description));
}

Option CommandLine::add_option(const std::string& names,
                               const std::function<void(const std::vector<std::string>&)>& keep,
                               const std::string& description) {
  return Option(
      impl_->app->add_option_function<std::vector<std::string>>(names, keep, description));
}

void CommandLine::remove_option(const std::string& name) {
  CLI::Option* const option = impl_->app->get_option_no_throw(name);
  if (option == nullptr) throw std::invalid_argument("there is no option " + name);
  impl_->app->remove_option(option);
}

const std::string& CommandLine::name() const { return impl_->app->get_name(); }

std::string CommandLine::description() const { return impl_->app->get_description(); }

std::string CommandLine::footer() const { return impl_->app->get_footer(); }

std::vector<OptionInfo> CommandLine::options() const {
  const CLI::App& app = *impl_->app;
  std::vector<OptionInfo> options;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) options.push_back(describe(*option));
  }
  for (const std::string& group : groups_in_order(app)) {
    for (const CLI::Option* option : app.get_options()) {
      if (!option->get_positional() && option->get_group() == group) {
        options.push_back(describe(*option));
      }
    }
  }
  return options;
}

bool CommandLine::has_option(const std::string& name) const {
  return impl_->app->get_option_no_throw(name) != nullptr;
}

bool CommandLine::takes_value(const std::string& name) const {
  return impl_->app->get_option_no_throw(name)->get_expected_min() > 0;
}

std::vector<const CommandLine*> CommandLine::subcommands() const {
  std::vector<const CommandLine*> all;
  for (const auto& subcommand : impl_->subcommands) all.push_back(subcommand.get());
  return all;
}

const CommandLine& CommandLine::subcommand(const std::string& name) const {
  for (const auto& subcommand : impl_->subcommands) {
    if (subcommand->name() == name) return *subcommand;
  }
  throw std::out_of_range("there is no subcommand " + name);
}

Request CommandLine::parse(std::vector<std::string> arguments) {
  std::reverse(arguments.begin(), arguments.end());  // CLI11 wants the last one first
  try {
    impl_->app->parse(std::move(arguments));
    return Request::kRun;
  } catch (const CLI::CallForHelp&) {
    return Request::kHelp;
  } catch (const CLI::CallForVersion&) {
    return Request::kVersion;
  } catch (const CLI::ParseError& error) {
    throw ArgumentError(error.what());
  }
}

std::string CommandLine::help() const { return impl_->app->help(); }

std::string CommandLine::version() const { return impl_->app->version(); }

const CommandLine* CommandLine::given_subcommand() const {
  const auto given = impl_->app->get_subcommands();
  return given.empty() ? nullptr : &subcommand(given.front()->get_name());
}

std::vector<std::string> CommandLine::unknown_arguments(bool deep) const {
  return impl_->app->remaining(deep);
}

bool CommandLine::is_given(std::string_view name) const {
  const CLI::Option* const option = impl_->app->get_option_no_throw(std::string(name));
  return option != nullptr && option->count() > 0;
}

std::vector<GivenOption> CommandLine::given_options() const {
  std::vector<GivenOption> given;
  const CLI::App& app = *impl_->app;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0) given.push_back({option->get_name(), option->results()});
  }
  return given;
}

std::string CommandLine::given_text() const { return impl_->app->config_to_str(); }

}  // namespace spillway::command
