"""SI units of scenes, `uncross check --units`, and scenes of real fibers, `uncross map`: docs/units.md."""
