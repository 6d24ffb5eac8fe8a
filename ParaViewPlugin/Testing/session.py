# SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
# SPDX-License-Identifier: BSD-3-Clause
"""Common setup of the ParaView test scripts."""

import os

from paraview import simple


def load_plugin():
    """Loads the plugin, on the server too if HOMEOMORPHISM_SERVER is host:port."""
    plugin = os.environ["HOMEOMORPHISM_PLUGIN"]
    server = os.environ.get("HOMEOMORPHISM_SERVER")
    if server:
        host, port = server.split(":")
        simple.Connect(host, int(port))
        simple.LoadPlugin(plugin, remote=True)
    simple.LoadPlugin(plugin, remote=False, ns=vars(simple))


def read(folder, name, in_pieces=False):
    if in_pieces:
        return simple.XMLPartitionedPolydataReader(FileName=[os.path.join(folder, name + ".pvtp")])
    return simple.XMLPolyDataReader(FileName=[os.path.join(folder, name + ".vtp")])
