// Checks the records of a report folder: what the page takes of them has the type it expects.
#pragma once

#include "io/json_reader.h"

namespace hemibake {

// Throw InputError "FILE: runs/3/cpu_seconds is …, expected a number" for a value of another type. Members
// that the page does not show are not looked at. json: the whole document, an object.
void check_checks_record(const JsonReader& json);    // check.json
void check_run_record(const JsonReader& json);       // run.json
void check_trade_record(const JsonReader& json);     // trade.json
void check_pictures_record(const JsonReader& json);  // render.json

}  // namespace hemibake
