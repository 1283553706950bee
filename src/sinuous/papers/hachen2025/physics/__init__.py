"""The robot in a physics engine: many targets, section IV, and cables that go slack."""
