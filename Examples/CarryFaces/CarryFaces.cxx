// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iostream>

int main()
{
  std::cout << "not yet\n";
  return 0;
}
