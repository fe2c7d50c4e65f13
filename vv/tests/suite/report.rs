//! Records, verdicts and the report: complete, repeatable, and refused when tampered with.

use std::collections::BTreeMap;
use std::path::Path;

use whipple_vv::claims::{Status, judge};
use whipple_vv::record::Records;
use whipple_vv::report::sig;

use crate::common::{Said, said};

/// The report of two fast cases.
fn report() -> (tempfile::TempDir, Said) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let said = said(
        folder.path(),
        &["vv", "heat-chain", "uniform-collapse", "--level", "quick", "--out", "r"],
    );
    (folder, said)
}

/// All files below a folder, with their contents.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut out = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            out.extend(
                files(&path).into_iter().map(|(below, text)| (format!("{name}/{below}"), text)),
            );
        } else {
            out.insert(name, std::fs::read(&path).expect("a file"));
        }
    }
    out
}

/// `vv` writes records, page, Markdown, tables and figures; `report` draws the same again to the
/// byte; `report --check` agrees, and objects to a changed page.
#[test]
fn report_is_complete_and_repeatable() {
    let (folder, ran) = report();
    assert_eq!(ran.code, Some(0), "{}{}", ran.out, ran.err);
    assert!(ran.out.contains("0 failed"), "{}", ran.out);
    let out = folder.path().join("r");
    let first = files(&out);
    let with = |end: &str| first.keys().filter(|name| name.ends_with(end)).count();
    assert!(
        first.contains_key("index.html") && first.contains_key("report.md"),
        "{:?}",
        first.keys()
    );
    assert!(with(".svg") >= 1 && with(".csv") >= 1, "figures and tables: {:?}", first.keys());
    assert_eq!(with(".json"), 3 * 2 + 3, "a record a run: {:?}", first.keys());
    let page = String::from_utf8_lossy(&first["index.html"]);
    assert!(page.contains("Heat along a chain") && page.contains("Uniform collapse"));
    assert!(!page.contains("NaN"));

    let again = said(folder.path(), &["report", "--out", "r"]);
    assert_eq!(again.code, Some(0), "{}", again.err);
    assert_eq!(files(&out), first, "byte for byte");
    let check = said(folder.path(), &["report", "--check", "--out", "r"]);
    assert_eq!((check.code, check.err.as_str()), (Some(0), ""));
    assert_eq!(files(&out), first, "a check writes nothing");

    std::fs::write(out.join("report.md"), "all is well").expect("a changed report");
    let check = said(folder.path(), &["report", "--check", "--out", "r"]);
    assert_eq!((check.code, check.out.as_str()), (Some(1), ""));
    assert_eq!(check.err, "error: not what the records give: report.md\n");
}

/// Cases without a record are named as not run, and not counted.
#[test]
fn cases_that_were_not_run_are_not_counted() {
    let (folder, ran) = report();
    assert!(ran.out.contains(" 0 failed, "), "{}", ran.out);
    let page = std::fs::read_to_string(folder.path().join("r/report.md")).expect("the report");
    let all = whipple_vv::cases::ALL.len();
    let summary = format!("{} cases were not run, and are not counted", all - 2);
    assert!(page.contains(&summary), "{summary}");
    let named = page.lines().find(|line| line.contains("Not run, so that")).expect("their names");
    assert!(named.contains("long-rod") && !named.contains("heat-chain"), "{named}");
    let cases = ["heat-chain", "uniform-collapse"].map(crate::common::case);
    let must =
        |claim: &&whipple_vv::claims::Claim| claim.weight == whipple_vv::claims::Weight::Must;
    let claims: usize = cases.iter().map(|case| case.claims().iter().filter(must).count()).sum();
    assert!(page.contains(&format!(" of {claims} required claims hold")), "{claims}");
    let again = said(folder.path(), &["report", "--out", "r"]);
    let [said_first, said_again] = [&ran.out, &again.out].map(|out| out.lines().next());
    assert_eq!(said_first, said_again, "the same counts");
}

/// A record that is cut, of another format, or with a wrong value is refused by name and place.
#[test]
fn broken_records_are_refused() {
    let (folder, _) = report();
    let path = folder.path().join("r/records/heat-chain_default_n16.json");
    let whole = std::fs::read_to_string(&path).expect("a record");
    let mut text = String::new();
    for broken in [
        whole[..whole.find("\"cpu_seconds\"").expect("a key")].to_owned(),
        whole.replacen("\"schema\": 1", "\"schema\": 0", 1),
        whole.replacen("\"threads\": 1", "\"threads\": \"one\"", 1),
        String::new(),
    ] {
        assert_ne!(broken, whole);
        std::fs::write(&path, broken).expect("a broken record");
        let said = said(folder.path(), &["report", "--out", "r"]);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
        assert!(said.err.contains("heat-chain_default_n16.json"), "{}", said.err);
        // The line depends on the length of the scene.
        let said = said.err.split(" at line ").next().expect("a message").trim_end().to_owned();
        text += &(said + "\n");
    }
    insta::assert_snapshot!(text);
}

/// A claim that does not hold fails the run, and a must claim sets the exit code.
#[test]
fn failed_claim_sets_the_exit_code() {
    let (folder, _) = report();
    let path = folder.path().join("r/records/heat-chain_default_n32.json");
    let whole = std::fs::read_to_string(&path).expect("a record");
    let mut record: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    record["norms"]["rate_error"] = 0.5.into();
    std::fs::write(&path, record.to_string()).expect("a record");
    let said = said(folder.path(), &["report", "--out", "r"]);
    assert_eq!(said.code, Some(1));
    assert!(said.out.starts_with("FAILED  heat-chain: rate of decay"), "{}", said.out);
}

/// The verdicts of the heat chain as a table: values to one digit.
#[test]
fn verdicts_of_a_case() {
    let (folder, _) = report();
    let records = Records::read(&folder.path().join("r/records")).expect("records");
    let case = crate::common::case("heat-chain");
    let row = |v: whipple_vv::claims::Verdict| {
        let bound = v.claim.wanted.text();
        let (kind, weight) = (v.claim.kind.name(), v.claim.weight.name());
        // Drifts are round-off, other than zero in their last digits only.
        let value =
            v.value.map_or("-".into(), |x| if x < 1e-12 { "round-off".into() } else { sig(x, 2) });
        format!("{kind} | {weight} | {} | {value} | {bound} | {:?}\n", v.claim.what, v.status)
    };
    let table: String = judge(case.claims(), &records).into_iter().map(row).collect();
    insta::assert_snapshot!(table);
    let none = judge(case.claims(), &Records::default());
    assert!(none.iter().all(|v| v.status == Status::Missing), "no record, no verdict");
}

/// `--single-file` has a page of its own: of the report nothing is overwritten, and a redraw leaves it.
#[test]
fn single_file_is_beside_the_report() {
    let (folder, _) = report();
    let out = folder.path().join("r");
    let light = b"light".as_slice();
    let hash = blake3::hash(light).to_hex().to_string();
    let path = out.join("records/heat-chain_default_n32.json");
    let whole = std::fs::read_to_string(&path).expect("a record");
    let mut record: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    record["pictures"] = serde_json::json!([
        { "id": "chain", "caption": "A hot chain.", "light": hash, "dark": hash }
    ]);
    std::fs::write(&path, record.to_string()).expect("a record");
    std::fs::create_dir(out.join("records/pictures")).expect("a folder");
    for name in ["chain.png", "chain-dark.png"] {
        std::fs::write(out.join("records/pictures").join(name), light).expect("a picture");
    }
    let report = |more: &[&str]| said(folder.path(), &[&["report", "--out", "r"], more].concat());
    std::fs::write(out.join("index.html"), "mine").expect("a page");
    let before = files(&out);
    assert_eq!(report(&["--check", "--single-file"]).code, Some(1), "it is not there yet");
    let drawn = report(&["--single-file"]);
    assert_eq!(drawn.code, Some(0), "{}", drawn.err);
    assert!(drawn.out.ends_with("report: r/single-file.html\n"), "{}", drawn.out);
    assert_eq!(report(&["--check", "--single-file"]).code, Some(0));
    let mut after = files(&out);
    let page = after.remove("single-file.html").expect("the page");
    assert!(after == before, "nothing else is written");
    let page = String::from_utf8(page).expect("text");
    assert!(page.contains("data:image/png;base64,") && !page.contains("\"figures/"));
    assert_eq!(report(&[]).code, Some(0));
    assert_eq!(report(&["--check"]).code, Some(0), "it is no part of the report");
    assert!(files(&out).get("single-file.html").is_some_and(|kept| kept == page.as_bytes()));
    let vv = ["vv", "heat-chain", "--level", "quick", "--out", "v", "--single-file"];
    let ran = said(folder.path(), &vv);
    assert!(ran.out.ends_with("report: v/index.html\nreport: v/single-file.html\n"), "{}", ran.out);
    // Without pictures they differ in nothing but links to what stands beside one and not beside the other.
    let page =
        |name: &str| std::fs::read_to_string(folder.path().join("v").join(name)).expect("a page");
    let [beside, alone] = ["index.html", "single-file.html"].map(page);
    assert!(beside.contains("href=\"records/") && !alone.contains("href=\"records/"));
    let unlinked = |page: &str| {
        let mut parts = page.split("<a href=\"records/");
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |text, part| {
            let inner = part.split_once("\">").map_or(part, |(_, rest)| rest);
            text + &inner.replacen("</a>", "", 1)
        })
    };
    assert!(unlinked(&beside) == alone, "they differ in more");
}

/// Pictures cannot be drawn again: they are kept as they are, shown, and refused when they are not those
/// of the record.
#[test]
fn pictures_are_kept_and_checked() {
    let (folder, _) = report();
    let records = folder.path().join("r/records");
    let path = records.join("heat-chain_default_n32.json");
    let whole = std::fs::read_to_string(&path).expect("a record");
    let mut record: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    let files = [("chain.png", b"light".as_slice()), ("chain-dark.png", b"dark")];
    let [light, dark] = files.map(|(_, bytes)| blake3::hash(bytes).to_hex().to_string());
    record["pictures"] = serde_json::json!([
        { "id": "chain", "caption": "A hot chain.", "light": light, "dark": dark }
    ]);
    std::fs::write(&path, record.to_string()).expect("a record");
    let report = |more: &[&str]| said(folder.path(), &[&["report", "--out", "r"], more].concat());
    let refused = |what: &str| {
        for more in [&[][..], &["--check"]] {
            let said = report(more);
            assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
            assert!(said.err.contains("chain-dark.png") || said.err.contains("chain.png"));
            assert!(said.err.contains(what), "{}", said.err);
            let again = "`whipple vv heat-chain --level quick --out r` makes it again";
            assert!(said.err.contains(again), "{}", said.err);
        }
    };
    refused("cannot be read");
    std::fs::create_dir(records.join("pictures")).expect("a folder");
    for (name, bytes) in files {
        std::fs::write(records.join("pictures").join(name), bytes).expect("a picture");
    }
    assert_eq!(report(&["--check"]).code, Some(1), "it is not in the report yet");
    assert_eq!(report(&[]).code, Some(0));
    assert_eq!(report(&["--check"]).code, Some(0));
    let read = |name: &str| std::fs::read(folder.path().join("r").join(name)).expect("a file");
    for (name, bytes) in files {
        assert_eq!(read(&format!("figures/{name}")), bytes);
    }
    let [page, text] = ["index.html", "report.md"].map(read);
    let [page, text] = [page, text].map(|bytes| String::from_utf8(bytes).expect("text"));
    assert!(page.contains("A hot chain.") && page.contains("src=\"figures/chain.png\""));
    assert!(text.contains("![A hot chain.](figures/chain.png)"));
    std::fs::write(folder.path().join("r/figures/chain.png"), "other").expect("a picture");
    let check = report(&["--check"]);
    assert_eq!((check.code, check.err.contains("figures/chain.png")), (Some(1), true));
    std::fs::write(records.join("pictures/chain-dark.png"), "altered").expect("a picture");
    refused("BLAKE3 is");
    let again = said(folder.path(), &["vv", "heat-chain", "--level", "quick", "--out", "r"]);
    assert_eq!(again.code, Some(0), "that command mends it: {}", again.err);
}

/// A folder without a record has no report.
#[test]
fn empty_records_are_no_report() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir_all(folder.path().join("r/records")).expect("a folder");
    for more in [&[][..], &["--check"]] {
        let said = said(folder.path(), &[&["report", "--out", "r"], more].concat());
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
        let begin = "error: no report in r: its folder `records` holds no record; ";
        assert!(said.err.starts_with(begin), "{}", said.err);
    }
    assert_eq!(files(&folder.path().join("r")).len(), 0, "nothing is written");
}
