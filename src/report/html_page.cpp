#include "report/html_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/compress.h"

namespace hemibake {
namespace {

// Marks of the places of the data in src/report/web/index.html.
constexpr std::string_view kTitlePlace = "<!-- title -->";
constexpr std::string_view kDataPlace = "<!-- data -->";
constexpr std::string_view kPlanesPlace = "<!-- planes -->";

std::string escape_html(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else
      escaped += c;
  }
  return escaped;
}

// Writes JSON for a script element, in which no `<` may stand; JSON has it in strings only.
std::string script_json(const nlohmann::ordered_json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  }
  return escaped;
}

// Returns `page` from `from` to `place`, and moves `from` behind it.
std::string_view take_until(std::string_view page, std::string_view place, size_t& from) {
  const size_t at = page.find(place, from);
  if (at == std::string_view::npos)
    throw std::logic_error("the page's template has no " + std::string(place));
  const std::string_view part = page.substr(from, at - from);
  from = at + place.size();
  return part;
}

}  // namespace

std::string fill_page(std::string_view page, const nlohmann::ordered_json& data, const PackedPlanes& planes,
                      std::span<const ReportPicture> pictures) {
  size_t at = 0;
  std::string filled(take_until(page, kTitlePlace, at));
  filled += escape_html(data.at("title").get<std::string>());
  filled += take_until(page, kDataPlace, at);
  filled += fmt::format("<script id=\"data\" type=\"application/json\">{}</script>", script_json(data));
  filled += take_until(page, kPlanesPlace, at);
  for (const PackedPlane& plane : planes.planes)
    filled += fmt::format("<script class=\"plane\" type=\"text/plain\" data-name=\"{}\">{}</script>\n",
                          plane.name, plane.base64);
  for (size_t i = 0; i < pictures.size(); ++i)
    if (!pictures[i].png.empty())
      filled += fmt::format("<script class=\"picture\" type=\"text/plain\" data-index=\"{}\">{}</script>\n",
                            i, base64(pictures[i].png));
  filled += page.substr(at);
  return filled;
}

}  // namespace hemibake
