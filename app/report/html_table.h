#pragma once
// A table of the page: what it shows as columns, how it looks in one place.
#include "app/report/comparison.h"

#include <functional>

namespace lodestone {

enum class Better : std::uint8_t { Neither, Less, More };

// A column of numbers. text: of a value; what has no value is a dash.
struct Column {
    std::string_view name;
    std::string_view tooltip;
    std::function<std::optional<double>(const ComparisonRow&)> value;
    std::function<std::string(double)> text;
    Better better = Better::Neither;
};

// A table: a row for the original and for every algorithm, also for those that failed.
struct Table {
    std::string_view id;
    std::string_view title;
    std::string_view lead; // a sentence below the title; may be empty
    std::vector<Column> columns;
    // Drawn between name and numbers; may be empty.
    std::string_view bar_name;
    std::function<std::string(const ComparisonRow&)> bar;
};

// A whole section: heading, table. Titles, names and tooltips are taken as markup.
std::string tableSection(const Comparison& comparison, const Table& table);

struct Part {
    std::string_view name;
    double value = 0.0;
    std::string text;
};

// Parts one after the other, each as long as its share of `longest`; coloured as .part-1,
// .part-2...
std::string stackedBar(const std::vector<Part>& parts, double longest);

} // namespace lodestone
