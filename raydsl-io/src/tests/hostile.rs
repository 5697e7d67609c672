use super::*;

/// Cuts a file at every seventh byte: an error of one line each time, but for cuts within
/// the white space at the end.
fn cut(extension: &str, bytes: &[u8], whole: &PointCloud) {
    for end in (0..bytes.len()).step_by(7) {
        match load_bytes(extension, &bytes[..end]) {
            Ok(cloud) => assert_eq!(&cloud, whole, "{extension} cut at {end}"),
            Err(e) => assert!(!e.to_string().contains('\n'), "{extension} cut at {end}: {e}"),
        }
    }
}

#[test]
fn cut_files_are_errors() {
    let cloud = small(40);
    for format in [2, 7] {
        let las = las_bytes(&cloud, format, false, 1);
        let whole = load_bytes("las", &las).expect("a cloud");
        cut("las", &las, &whole);
        cut("laz", &las_bytes(&cloud, format, true, 1), &whole);
    }
    for encoding in ["binary_little_endian", "binary_big_endian"] {
        cut("ply", &ply_bytes(&cloud, encoding), &cloud);
    }
    assert_modest();
}

/// A text file may end within its last number, which cannot be seen; what comes before is
/// as in the whole file.
#[test]
fn cut_text_keeps_its_start() {
    let cloud = small(40);
    let rows = cloud.positions.iter().zip(&cloud.colors);
    let text: String =
        rows.map(|([x, y, z], [r, g, b])| format!("{x} {y} {z} {r} {g} {b}\n")).collect();
    for (extension, bytes) in [("xyz", text.into_bytes()), ("ply", ply_bytes(&cloud, "ascii"))] {
        for end in (0..bytes.len()).step_by(7) {
            if let Ok(part) = load_bytes(extension, &bytes[..end]) {
                let n = part.positions.len() - 1;
                assert_eq!(part.positions[..n], cloud.positions[..n], "{extension} at {end}");
            }
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    let cloud = small(40);
    let files = [
        ("las", las_bytes(&cloud, 3, false, 1)),
        ("laz", las_bytes(&cloud, 3, true, 1)),
        ("laz", las_bytes(&cloud, 2, true, 1)),
        ("laz", las_bytes(&cloud, 7, true, 1)),
        ("ply", ply_bytes(&cloud, "ascii")),
        ("ply", ply_bytes(&cloud, "binary_little_endian")),
    ];
    for (extension, bytes) in files {
        for at in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                if let Err(e) = load_bytes(extension, &damaged) {
                    assert!(!e.to_string().contains('\n'), "{extension} at {at}: {e}");
                }
            }
        }
    }
    assert_modest();
}

#[test]
fn claims_are_not_trusted() {
    let mut las = las_bytes(&small(3), 7, false, 1);
    // The 64-bit count of LAS 1.4, and the older one, which would come first.
    las[247..255].copy_from_slice(&(1u64 << 60).to_le_bytes());
    las[107..111].fill(0);
    assert!(message("las", &las).contains("3 of 1152921504606846976 points"));
    let mut laz = las_bytes(&small(3), 7, true, 1);
    laz[247..255].copy_from_slice(&(1u64 << 60).to_le_bytes());
    laz[107..111].fill(0);
    assert!(message("laz", &laz).contains("thin or tile"));
    laz[247..255].copy_from_slice(&u64::from(u32::MAX).to_le_bytes());
    message("laz", &laz);
    // An extended record of 2^60 bytes is not looked at.
    let mut las = las_bytes(&small(3), 7, false, 1);
    let end = las.len() as u64;
    las[235..243].copy_from_slice(&end.to_le_bytes());
    las[243..247].copy_from_slice(&1u32.to_le_bytes());
    las.extend([0; 20]);
    las.extend((1u64 << 60).to_le_bytes());
    las.extend([0; 32]);
    assert_eq!(load_bytes("las", &las).expect("a cloud").positions.len(), 3);
    let head = "ply\nformat binary_little_endian 1.0\nelement empty 1152921504606846976\n\
                element vertex 1152921504606846976\nproperty float x\nproperty float y\n\
                property float z\nend_header\n";
    assert!(message("ply", head.as_bytes()).contains("thin or tile"));
    let head = head.replace("vertex 1152921504606846976", "vertex 4000000000");
    assert!(message("ply", head.as_bytes()).contains("0 of 4000000000 elements 'vertex'"));
    assert_modest();
}

#[test]
fn bad_values_are_named() {
    let lines = |text: &str| message("xyz", text.as_bytes());
    assert!(lines("1 2 3\n1 2\n").contains(":2: is no valid XYZ: it has 2 columns"));
    assert!(lines("1 2 3\n1 two 3\n").contains("'two' is no number"));
    assert!(lines("1 2 3 4\n").contains("`x y z r g b`"));
    assert!(lines("1 2 3 0 0 300\n").contains("300"));
    assert!(lines("1 2 3\nnan 0 0\n1 inf 2\n").contains("2 of 3 points"));
    assert!(lines("nan 0 0\n1 1 1\n").contains("the first is point 0"));
    assert!(lines("# nothing\n").contains("holds no point"));
    assert!(lines(&"1".repeat(2_000_000)).contains("longer than"));
    assert!(message("ply", b"").contains("cut off"));
    assert!(message("ply", b"no\n").contains("PLY"));
    assert!(message("laz", b"LASF").contains("cut off"));
    assert!(message("las", &[7; 500]).contains("LAS"));
    assert!(message("tif", b"").contains("'tif'"));
    let missing = cloud::load("no-such-file.laz", &mut |_, _| {});
    assert!(matches!(missing, Err(LoadError::Missing { .. })));
}

/// Several bytes changed at once, which gets past checks that one byte fails.
#[test]
fn much_damaged_files_never_panic() {
    let cloud = small(40);
    let rows = cloud.positions.iter().zip(&cloud.colors);
    let text: String =
        rows.map(|([x, y, z], [r, g, b])| format!("{x} {y} {z} {r} {g} {b}\n")).collect();
    let files = [
        ("las", las_bytes(&cloud, 7, false, 1)),
        ("laz", las_bytes(&cloud, 3, true, 1)),
        ("laz", las_bytes(&cloud, 7, true, 1)),
        ("ply", ply_bytes(&cloud, "ascii")),
        ("ply", ply_bytes(&cloud, "binary_big_endian")),
        ("xyz", text.into_bytes()),
    ];
    let mut state = 1u64;
    let mut random = move |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for (extension, bytes) in files {
        for round in 0..500 {
            let mut damaged = bytes.clone();
            for _ in 0..=random(8) {
                // Half of the damage is where headers are.
                let end = if random(2) == 0 { bytes.len() } else { bytes.len().min(375) };
                damaged[random(end)] = [0, 1, 0x7f, 0xff, b'9', b' ', b'\n'][random(7)];
            }
            if let Err(e) = load_bytes(extension, &damaged) {
                assert!(!e.to_string().contains('\n'), "{extension}, round {round}: {e}");
            }
        }
    }
    assert_modest();
}

/// A device has no end, and a pipe waits for a writer.
#[cfg(unix)]
#[test]
fn devices_are_refused() {
    let path = std::env::temp_dir().join(format!("raydsl-io-{}-zero.xyz", std::process::id()));
    std::os::unix::fs::symlink("/dev/zero", &path).expect("a link");
    let found = cloud::load(&path, &mut |_, _| {});
    std::fs::remove_file(&path).expect("it is there");
    assert!(matches!(found, Err(LoadError::Unreadable { .. })), "{found:?}");
}
