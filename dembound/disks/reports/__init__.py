"""Reports on a case and its run: facts, warnings, summary, expected errors, meshes for pictures, bytes on disk."""
