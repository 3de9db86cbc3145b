#include "pack/rounded_family.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "geometry/for_each_branch.h"

namespace lacerta {

uint64_t RoundedFamily::size() const {
  return std::accumulate(members.begin(), members.end(), uint64_t{0}, [](uint64_t sum, const DracoEncoded& member) { return sum + member.bytes.size(); });
}

// What `make` gives for each primitive, several at a time; fails where one fails.
template <typename T, typename Make>
StatusOr<std::vector<T>> FamilyCoder::OfEachMember(const Make& make) const {
  std::vector<StatusOr<T>> made(primitives_.size(), InternalError("not made"));
  ForEachBranch(primitives_.size(), [&](size_t m) { made[m] = make(m); });
  std::vector<T> result;
  for (StatusOr<T>& one : made) {
    LACERTA_RETURN_IF_ERROR(one.status());
    result.push_back(std::move(one).value());
  }
  return result;
}

RoundedFamily FamilyCoder::RoundedAt(const RoundingLevels& levels) {
  const RoundedPositions& positions = forecast_.Positions(levels.positions);
  RoundedFamily family;
  family.error = positions.distance;
  family.precisions.assign(primitives_.size(), DracoPrecision{positions.lattice, {}, 0});
  for (const Primitive* primitive : primitives_) {
    family.reports.emplace_back();
    for (const Attribute& attribute : primitive->attributes) {
      if (attribute.name != "POSITION") family.reports.back().push_back({attribute.name, 0, 0.0, ""});
    }
  }
  for (size_t m = 0; m < primitives_.size(); ++m) {
    if (primitives_[m]->Find("POSITION")->data.type == ComponentType::kFloat) family.precisions[m].values["POSITION"] = MakeFloatAccessor(positions.moved[m]);
  }
  for (size_t a = 0; a < attributes_.size(); ++a) {
    const RoundedAttribute& attribute = attributes_[a];
    const int level = levels.attributes[a];
    SetAttribute(a, level, positions, &family);
    if (level > kMostLevel || !attribute.is_shown) continue;
    const std::vector<AccessorData>& fitted = forecast_.Fitted(a, levels.positions);  // to where positions have slid
    for (size_t p = 0; p < fitted.size(); ++p) SetPart(attribute.parts[p], attribute.RoundedAt(fitted[p], attribute.parts[p], level), &family);
  }
  return family;
}

void FamilyCoder::SetValues(size_t a, const DescendedValues& descent, const RoundedPositions& positions, RoundedFamily* family) {
  SetAttribute(a, descent.level, positions, family);
  for (size_t p = 0; p < descent.values.size(); ++p) SetPart(attributes_[a].parts[p], descent.values[p], family);
}

Status FamilyCoder::Code(RoundedFamily* family, DracoSearch search) const {
  const auto code = [&](size_t m) { return EncodeDracoPrimitive(*primitives_[m], family->precisions[m], search); };
  LACERTA_ASSIGN_OR_RETURN(family->members, OfEachMember<DracoEncoded>(code));
  return Status();
}

Status FamilyCoder::CodeInOtherOrder(RoundedFamily* family) const {
  const auto code = [&](size_t m) { return EncodeInOtherOrder(*primitives_[m], family->precisions[m], family->members[m]); };
  LACERTA_ASSIGN_OR_RETURN(family->members, OfEachMember<DracoEncoded>(code));
  return Status();
}

StatusOr<uint64_t> FamilyCoder::BytesAsCoded(const RoundedFamily& family) const {
  const auto bytes_of = [&](size_t m) { return DracoPrimitiveBytes(*primitives_[m], family.precisions[m], family.members[m].coding); };
  LACERTA_ASSIGN_OR_RETURN(const std::vector<uint64_t> sizes, OfEachMember<uint64_t>(bytes_of));
  return std::accumulate(sizes.begin(), sizes.end(), uint64_t{0});
}

uint64_t FamilyCoder::FewestBytes(double error) const {
  constexpr int kTooCoarse = 2 * kLevelsPerBit;
  const Lattice positions = forecast_.LatticeAt(std::max(1, forecast_.StartLevel(error) - kTooCoarse));
  const auto bytes_of = [&](size_t m) {
    const TriangleMesh surface = Surface(*primitives_[m]);
    Primitive coarse{surface.positions.size(), surface.triangles, {{"POSITION", MakeFloatAccessor(surface.positions)}}};
    DracoPrecision precision{positions, {}, 0};
    for (size_t a = 0; a < attributes_.size(); ++a) {
      const RoundedAttribute& attribute = attributes_[a];
      const int level = attribute.is_shown ? attribute.AtOrAbove(attribute.StartLevel() - kTooCoarse) : attribute.FirstLevel();
      for (const RoundedAttribute::Part& part : attribute.parts) {
        if (part.member != m) continue;
        coarse.attributes.push_back(primitives_[m]->attributes[part.index]);
        SetPrecision(a, part, level, &precision);
      }
    }
    return DracoPrimitiveBytes(coarse, precision, {});
  };
  const StatusOr<std::vector<uint64_t>> sizes = OfEachMember<uint64_t>(bytes_of);
  return sizes.ok() ? std::accumulate(sizes.value().begin(), sizes.value().end(), uint64_t{0}) : 0;
}

// Has a part of an attribute coded at a level. Gives its bits.
int FamilyCoder::SetPrecision(size_t a, const RoundedAttribute::Part& part, int level, DracoPrecision* precision) const {
  const RoundedAttribute& attribute = attributes_[a];
  if (attribute.octahedral) return precision->normal_bits = level / kLevelsPerBit;
  const Lattice lattice = attribute.LatticeAt(part, level);
  precision->lattices[primitives_[part.member]->attributes[part.index].name] = lattice;
  return lattice.bits;
}

void FamilyCoder::SetAttribute(size_t a, int level, const RoundedPositions& positions, RoundedFamily* family) {
  if (level > kMostLevel) return;
  for (const RoundedAttribute::Part& part : attributes_[a].parts) {
    const int bits = SetPrecision(a, part, level, &family->precisions[part.member]);
    for (AttributeReport& report : family->reports[part.member]) {
      if (report.name != primitives_[part.member]->attributes[part.index].name) continue;
      report.bits = bits;
      report.error = std::hypot(forecast_.Rounded(a, level), positions.slides[a]);
      report.unit = attributes_[a].unit;
    }
  }
}

void FamilyCoder::SetPart(const RoundedAttribute::Part& part, AccessorData values, RoundedFamily* family) const {
  family->precisions[part.member].values[primitives_[part.member]->attributes[part.index].name] = std::move(values);
}

}  // namespace lacerta
