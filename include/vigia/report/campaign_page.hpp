#pragma once

#include <string>

namespace vigia::report {

/// A self-contained page, one HTML file without any reference to another, of a campaign: its arms
/// as a table that sorts, outcomes, errors, consistency and cost as charts, the worst missions with
/// their commands. @p data_json is an object of
/// - `title`, `subtitle`: texts;
/// - `summary`: the campaign's summary.json;
/// - `results`: of each arm its `name`, `outcomes` ({name, count, of, low, high}), `boxes` (by
///   figure {low, q1, median, q3, high, max}) and `points` ([bound, error] of missions, m);
/// - `bands`: by a number of missions {low, high}, in which the ANEES of so many lies;
/// - `notes`: texts that stand above all.
/// What is missing is left out of the page; texts are shown as text, whatever they hold.
std::string campaign_page(const std::string& title, const std::string& data_json);

}  // namespace vigia::report
