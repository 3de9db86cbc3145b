// What the commands print: tables for people, JSON for programs.
#ifndef LACERTA_CLI_REPORT_H_
#define LACERTA_CLI_REPORT_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lacerta/codec.h"
#include "lacerta/gltf.h"

namespace lacerta::cli {

using Json = nlohmann::ordered_json;

// Numbers that JSON cannot say (infinite, NaN) become null.
Json NumberOrNull(double value);

Json ToJson(const EncodeReport& report);
Json ToJson(const PackReport& report);
Json ToJson(const StreamInfo& stream);
Json ToJson(const std::vector<PrimitiveInfo>& primitives);

void PrintJson(const Json& json);

// Rows of cells under a header, columns aligned to the right.
void PrintTable(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

// A number with a fixed count of decimals, or in scientific form with that many significant digits.
std::string Fixed(double value, int decimals);
std::string Short(double value, int digits);

const char* StorageName(PrimitiveStorage storage);
const char* FallbackName(Fallback fallback);

void PrintLevels(const EncodeReport& report);
void PrintPrecision(const PrimitiveReport& report);  // one line: bits and measured error per attribute
void PrintLevels(const StreamInfo& stream);
void PrintPrimitives(const std::vector<PrimitiveInfo>& primitives);  // those that are no stream

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_REPORT_H_
