#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

/// Fields of a result that may be incomplete: absent and null are the same, a wrong type is an error.
///
/// Each throws std::invalid_argument, naming the key, when the value is there but has another type.
namespace snare::base::json_fields {

/// The value of a key; null when it is absent or `object` is no object.
const nlohmann::json& member(const nlohmann::json& object, const std::string& key);

std::optional<double> number(const nlohmann::json& object, const std::string& key);

std::string text(const nlohmann::json& object, const std::string& key, const std::string& otherwise = "");

/// The array of a key; empty when it is absent.
const nlohmann::json& array(const nlohmann::json& object, const std::string& key);

/// The numbers of an array up to the first null, where a solve did not arrive.
std::vector<double> numbers(const nlohmann::json& object, const std::string& key);

/// The texts of an array without its nulls.
std::vector<std::string> texts(const nlohmann::json& object, const std::string& key);

}  // namespace snare::base::json_fields
