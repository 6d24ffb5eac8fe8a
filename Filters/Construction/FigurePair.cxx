// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "FigurePair.h"

namespace homeomorphism
{
namespace
{

std::string List(const std::vector<int>& ids, const std::vector<std::string>& names)
{
  std::string list;
  for (const int id : ids)
  {
    const std::size_t i = static_cast<std::size_t>(id);
    list += (list.empty() ? "" : ", ") + (i < names.size() ? names[i] : std::to_string(id));
  }
  return list;
}

const char* Words(FigureProblem::Remedy remedy)
{
  switch (remedy)
  {
    case FigureProblem::Remedy::None:
      return "";
    case FigureProblem::Remedy::MovePoints:
      return " Correct the positions of these points.";
    case FigureProblem::Remedy::RemovePoints:
      return " Remove or merge these points.";
    case FigureProblem::Remedy::RemoveSegments:
      return " Correct the points, remove the segment, or leave out conflicting segments.";
    case FigureProblem::Remedy::CorrectCells:
      return " Give both figures the same points and cells.";
    case FigureProblem::Remedy::GiveFrames:
      return " Add points off the line, or set frames.";
    case FigureProblem::Remedy::EnlargeFrames:
      return " Enlarge the frame, or remove these points.";
    case FigureProblem::Remedy::UseFrames:
      return " Use frames instead.";
    case FigureProblem::Remedy::AllowMorePoints:
      return " Allow more added points.";
  }
  return "";
}

} // namespace

FigureProblem::Remedy FigureProblem::GetRemedy() const
{
  switch (this->What)
  {
    case Kind::Empty:
    case Kind::PointCountsDiffer:
    case Kind::BadCell:
    case Kind::CellsDiffer:
      return Remedy::CorrectCells;
    case Kind::NotFinite:
    case Kind::NotPlanar:
    case Kind::OutlineAgainstHole:
    case Kind::LoopSense:
    case Kind::Precision:
      return Remedy::MovePoints;
    case Kind::Coincident:
      return Remedy::RemovePoints;
    case Kind::Crossing:
    case Kind::PointOnSegment:
    case Kind::CyclicOrder:
    case Kind::OtherFace:
      return Remedy::RemoveSegments;
    case Kind::Collinear:
      return Remedy::GiveFrames;
    case Kind::OutsideDomain:
    case Kind::BadFrame:
      return Remedy::EnlargeFrames;
    case Kind::HullsDiffer:
      return Remedy::UseFrames;
    case Kind::PointLimit:
      return Remedy::AllowMorePoints;
    case Kind::Aborted:
      break;
  }
  return Remedy::None;
}

std::string FigureProblem::Message(const std::vector<std::string>& names) const
{
  const std::string where =
    this->Domain < 0 ? "" : (this->Domain == 0 ? " in the source" : " in the target");
  const std::string points = List(this->Points, names);
  const std::string loop = this->Loop < 0 ? "A loop" : "Loop " + std::to_string(this->Loop);
  std::string text;
  switch (this->What)
  {
    case Kind::Empty:
      text = "The figure has fewer than three points.";
      break;
    case Kind::PointCountsDiffer:
      text = "Source and target do not have the same number of points.";
      break;
    case Kind::BadCell:
      text =
        "A loop or line refers to a point that does not exist, repeats a point, or is too short.";
      break;
    case Kind::CellsDiffer:
      text = "Source and target do not have the same cells.";
      break;
    case Kind::NotFinite:
      text = "Coordinates are not finite" + where + ": points " + points + ".";
      break;
    case Kind::NotPlanar:
      text =
        "The figure does not lie in a plane" + where + ": the farthest point is " + points + ".";
      break;
    case Kind::Collinear:
      text = "All points lie on one line" + where + ".";
      break;
    case Kind::Coincident:
      text = "Points have the same position" + where + ": " + points + ".";
      break;
    case Kind::Crossing:
      text = "Segments cross" + where + "; their ends are the points " + points + ".";
      break;
    case Kind::PointOnSegment:
      text = "A point lies on a segment" + where +
        " only; the point and the ends of the segment are " + points + ".";
      break;
    case Kind::CyclicOrder:
      text =
        "Segments have different cyclic orders around points " + points + " in source and target.";
      break;
    case Kind::OtherFace:
      text = "Segments surround points in only one of source and target: " + points + ".";
      break;
    case Kind::OutlineAgainstHole:
      text = loop + " is an outline in one of source and target, and a hole in the other: points " +
        points + ".";
      break;
    case Kind::LoopSense:
      text = loop + " is mirrored in the target and the first loop is not, or the reverse.";
      break;
    case Kind::OutsideDomain:
      text = "Points are outside the domain" + where + ": " + points + ".";
      break;
    case Kind::HullsDiffer:
      text = "The convex hulls differ: points " + points + " are on only one of them.";
      break;
    case Kind::BadFrame:
      text = "The frame is not a convex polygon" + where +
        ", or the frames have different numbers of corners.";
      break;
    case Kind::PointLimit:
      text = std::to_string(this->Count) +
        " points have to be added, which is more than allowed; the first one near points " +
        points + ".";
      break;
    case Kind::Precision:
      text = "Double precision does not suffice in the region of points " + points + ".";
      break;
    case Kind::Aborted:
      text = "Stopped on request.";
      break;
  }
  return text + Words(this->GetRemedy());
}

FigureProblem MakeProblem(
  FigureProblem::Kind kind, int domain, std::vector<int> points, int line, int loop)
{
  FigureProblem problem;
  problem.What = kind;
  problem.Domain = domain;
  problem.Count = static_cast<int>(points.size());
  problem.Points = std::move(points);
  problem.Points.resize(std::min<std::size_t>(problem.Points.size(), 10));
  problem.Line = line;
  problem.Loop = loop;
  return problem;
}

} // namespace homeomorphism
