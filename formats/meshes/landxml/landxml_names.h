#pragma once

#include "src/rooms.h"
// What writer and reader of LandXML agree on: see docs/formats-meshes.md ("LandXML").

namespace spillway::formats::landxml {

inline constexpr const char* kEpsgCode = "epsgCode";
inline constexpr const char* kWkt = "ogcWktCode";
/// The Feature of a surface that holds Spillway's notes, each a Property of label kNote.
inline constexpr const char* kNotes = "Spillway";
inline constexpr const char* kNote = "note";

}  // namespace spillway::formats::landxml
