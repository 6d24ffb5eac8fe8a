// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Benchmark.cxx
/// Times single rows on request of benchmark.py, so that rows of this program and of Python can
/// take turns.
///
///   HomeomorphismBenchmark FOLDER
///
/// reads the workload from a folder (see Workload.h) and then commands from standard input, each
/// answered with one line:
///
/// - `rows`: the names of all rows;
/// - `run ROW POINTS THREADS`: seconds of wall time and of processor time that the row took for the
///   points in points-POINTS.f64;
/// - `save FILE`: writes the result of the last run as it is in memory, answers with its size in
///   bytes;
/// - `roundtrip ROW BACK POINTS`: the largest difference of a coordinate after the two rows;
/// - `memory ROW`: the bytes that a row "construct/..." allocates and keeps, and their peak.

#include "Rows.h"
#include "Workload.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

double* Coordinates(vtkPoints* points)
{
  return vtkDoubleArray::SafeDownCast(points->GetData())->GetPointer(0);
}

namespace
{

struct Times
{
  double Clock;
  double Processors;
};

double ProcessorTime()
{
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class Session
{
public:
  explicit Session(const std::string& folder)
    : Data(folder)
  {
    AddHomeomorphismRows(this->Data, this->AllRows);
    AddPeerRows(this->Data, this->AllRows);
    AddBoundRows(this->Data, this->AllRows);
    AddConstructionRows(this->Data, this->AllRows);
    if (this->Data.Image)
    {
      AddImageRows(this->Data, this->AllRows);
    }
  }

  std::string Answer(const std::string& line)
  {
    std::istringstream words(line);
    std::ostringstream answer;
    answer.precision(9);
    std::string command;
    words >> command;
    if (command == "rows")
    {
      for (const auto& row : this->AllRows)
      {
        answer << row.first << " ";
      }
    }
    else if (command == "run")
    {
      std::string name;
      std::string points;
      int threads = 0;
      words >> name >> points >> threads;
      const Times times = this->Run(this->Find(name), points, threads);
      answer << times.Clock << " " << times.Processors;
    }
    else if (command == "save")
    {
      std::string file;
      std::getline(words >> std::ws, file);
      answer << this->Save(file);
    }
    else if (command == "roundtrip")
    {
      std::string name;
      std::string back;
      std::string points;
      words >> name >> back >> points;
      answer << this->RoundTrip(this->Find(name), this->Find(back), points);
    }
    else if (command == "memory")
    {
      std::string name;
      words >> name;
      Task task = this->MakeTask(this->NoPoints, 1);
      const Memory memory = MeasureMemory(this->Find(name), task);
      answer << memory.Kept << " " << memory.Peak;
    }
    else
    {
      throw std::runtime_error("unknown command " + command);
    }
    return answer.str();
  }

private:
  Row& Find(const std::string& name)
  {
    const auto found = this->AllRows.find(name);
    if (found == this->AllRows.end())
    {
      throw std::runtime_error("there is no row " + name);
    }
    return found->second;
  }

  vtkPoints* FindPoints(const std::string& name)
  {
    const auto found = this->Data.Points.find(name);
    if (found == this->Data.Points.end())
    {
      throw std::runtime_error("there are no points " + name);
    }
    return found->second;
  }

  Task MakeTask(vtkPoints* in, int threads)
  {
    vtkSMPTools::Initialize(threads);
    vtkSmartPointer<vtkPoints>& out = this->Out[in];
    if (!out)
    {
      out = vtkSmartPointer<vtkPoints>::New();
      out->SetDataTypeToDouble();
    }
    out->SetNumberOfPoints(in->GetNumberOfPoints());
    return { in, out, threads, nullptr };
  }

  Times Run(Row& row, const std::string& points, int threads)
  {
    Task task = this->MakeTask(this->FindPoints(points), threads);
    return this->Run(row, task);
  }

  Times Run(Row& row, Task& task)
  {
    if (row.Before)
    {
      row.Before(task);
    }
    const double processors = ProcessorTime();
    const auto start = std::chrono::steady_clock::now();
    row.Run(task);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const Times times{ time.count(), ProcessorTime() - processors };
    if (row.After)
    {
      row.After(task);
    }
    this->Result = task.Result ? task.Result.Get() : task.Out->GetData();
    return times;
  }

  long long Save(const std::string& path)
  {
    const auto size = static_cast<std::streamsize>(this->Result->GetNumberOfValues()) *
      this->Result->GetDataTypeSize();
    std::ofstream file(path, std::ios::binary);
    file.write(static_cast<const char*>(this->Result->GetVoidPointer(0)), size);
    if (!file)
    {
      throw std::runtime_error("cannot write " + path);
    }
    return size;
  }

  double RoundTrip(Row& there, Row& back, const std::string& points)
  {
    Task task = this->MakeTask(this->FindPoints(points), 1);
    this->Run(there, task);
    vtkNew<vtkPoints> images;
    images->SetDataTypeToDouble();
    images->SetNumberOfPoints(task.In->GetNumberOfPoints());
    vtkNew<vtkPoints> preimages;
    preimages->SetDataTypeToDouble();
    preimages->SetNumberOfPoints(task.In->GetNumberOfPoints());
    images->GetData()->DeepCopy(this->Result);
    Task returning{ images, preimages, 1, nullptr };
    this->Run(back, returning);
    double largest = 0.0;
    const double* in = Coordinates(task.In);
    for (vtkIdType i = 0; i < this->Result->GetNumberOfTuples(); ++i)
    {
      double preimage[3];
      this->Result->GetTuple(i, preimage);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double difference = std::abs(preimage[axis] - in[3 * i + axis]);
        // NaN is the largest value.
        largest = difference <= largest ? largest : difference;
      }
    }
    return largest;
  }

  Workload Data;
  Rows AllRows;
  vtkNew<vtkPoints> NoPoints;
  std::map<vtkPoints*, vtkSmartPointer<vtkPoints>> Out;
  vtkSmartPointer<vtkDataArray> Result;
};

} // namespace

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "Usage: HomeomorphismBenchmark FOLDER\n";
    return EXIT_FAILURE;
  }
  try
  {
    Session session(argv[1]);
    std::string line;
    while (std::getline(std::cin, line))
    {
      std::cout << session.Answer(line) << std::endl;
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << "HomeomorphismBenchmark: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
